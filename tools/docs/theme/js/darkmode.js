// Light or dark: as the system has it, until a reader chooses.

(function () {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const chosen = () => {
    try {
      return localStorage.getItem("mkdocs-colormode") ?? "auto";
    } catch {
      return "auto";
    }
  };
  function show(mode) {
    const isDark = mode === "dark" || (mode === "auto" && dark.matches);
    document.documentElement.setAttribute("data-bs-theme", isDark ? "dark" : "light");
  }
  show(chosen());
  dark.addEventListener("change", () => show(chosen()));
  addEventListener("DOMContentLoaded", () => {
    for (const button of document.querySelectorAll("[data-bs-theme-value]")) {
      button.addEventListener("click", () => {
        const mode = button.getAttribute("data-bs-theme-value");
        try {
          localStorage.setItem("mkdocs-colormode", mode);
        } catch {
          // It is not kept.
        }
        show(mode);
      });
    }
  });
})();

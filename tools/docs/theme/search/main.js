// Search without a server: the texts are a script beside this one. All words must be there, or begin one that is; sections
// with the words in their titles come first, then those that say them most often.
// The page has `base_url`, the way to the root of the site.

// The dialogue stands behind this script.
addEventListener("DOMContentLoaded", () => {
  const results = document.getElementById("mkdocs-search-results");
  const query = document.getElementById("mkdocs-search-query");
  if (!results || !query) return;
  /** Sections that are shown. */
  const MOST = 40;

  const plain = (text) => text.replace(/&lt;/g, "<").replace(/&gt;/g, ">").replace(/&quot;/g, '"').replace(/&amp;/g, "&");
  let ready = null;
  /** The sections, once they are loaded: {location, title, text}. */
  function sections() {
    ready ??= new Promise((loaded, failed) => {
      const script = Object.assign(document.createElement("script"), { src: `${base_url}/search/search_index.js`, onerror: failed });
      script.onload = () => loaded(searchIndex.docs.map(({ location, title, text }) => ({ location, title: plain(title), text: plain(text) })));
      document.head.append(script);
    });
    return ready;
  }

  /** How well a section suits; 0 where a word is missing. */
  function worth({ title, text }, words) {
    let sum = 0;
    for (const word of words) {
      const [inTitle, inText] = [title, text].map((where) => (where.match(word) ?? []).length);
      if (inTitle + inText === 0) return 0;
      sum += 20 * inTitle + Math.min(inText, 10);
    }
    return sum;
  }

  function shown({ location, title, text }, words) {
    const link = Object.assign(document.createElement("a"), { href: `${base_url}/${location}`, textContent: title });
    const from = Math.max(0, text.search(words[0]) - 60);
    const heading = document.createElement("h3");
    heading.append(link);
    const article = document.createElement("article");
    article.append(heading, Object.assign(document.createElement("p"), { textContent: text.slice(from, from + 200) }));
    return article;
  }

  let asked = 0;
  query.addEventListener("input", async () => {
    const own = ++asked;
    const all = await sections();
    if (own !== asked) return;
    const escaped = query.value.split(/\s+/).filter((word) => word.length > 1).map((word) => word.replace(/[^\p{L}\p{N}_]/gu, "\\$&"));
    const words = escaped.map((word) => new RegExp(`(?<![\\p{L}\\p{N}])${word}`, "giu"));
    const rated = words.length === 0 ? [] : all.map((section) => [worth(section, words), section]).filter(([found]) => found > 0);
    rated.sort((a, b) => b[0] - a[0]);
    const none = Object.assign(document.createElement("p"), { textContent: words.length > 0 ? "Nothing was found." : "Type to begin." });
    results.replaceChildren(...(rated.length > 0 ? rated.slice(0, MOST).map(([, section]) => shown(section, words)) : [none]));
  });
});

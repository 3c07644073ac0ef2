//! The page and its libraries, in the program.
//!
//! | library | version | licence | source |
//! | --- | --- | --- | --- |
//! | three | 0.184.0, the last release with a minified module build | MIT | npm package `three`, `build/`; the copy of `gearmesh_report::page` |
//! | uPlot | 1.6.32 | MIT | the copy of `gearmesh_report::page` |
//!
//! Both stand as published; a test compares their SHA-256. A table, and not a folder: what is not named here is not
//! served.

use gearmesh_report::page::{
    DRAWING_SCRIPT, DRAWING_STYLE, SCENE_3D, THREE_CORE, THREE_MODULE, UPLOT_SCRIPT, UPLOT_STYLE,
    VIEW_3D,
};

/// A file of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Asset {
    /// Name behind `/assets/`; the page itself has none.
    pub name: &'static str,
    /// Its media type.
    pub kind: &'static str,
    /// Its text.
    pub text: &'static str,
}

const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
const PAGE: &str = "text/html; charset=utf-8";
const PICTURE: &str = "image/svg+xml";

macro_rules! own {
    ($($name:literal $kind:ident),* $(,)?) => {
        [$(Asset { name: $name, kind: $kind, text: include_str!(concat!("../assets/", $name)) }),*]
    };
}

const OWN: [Asset; 26] = own!(
    "index.html" PAGE,
    "studio.css" STYLE,
    "icon.svg" PICTURE,
    "main.js" SCRIPT,
    "pair.js" SCRIPT,
    "new.js" SCRIPT,
    "outcome.js" SCRIPT,
    "bevel_space.js" SCRIPT,
    "seek.js" SCRIPT,
    "dom.js" SCRIPT,
    "said.js" SCRIPT,
    "job.js" SCRIPT,
    "server.js" SCRIPT,
    "state.js" SCRIPT,
    "form.js" SCRIPT,
    "curves.js" SCRIPT,
    "motion.js" SCRIPT,
    "mechanism.js" SCRIPT,
    "modes.js" SCRIPT,
    "choice.js" SCRIPT,
    "orbit.js" SCRIPT,
    "planets.js" SCRIPT,
    "waterfall.js" SCRIPT,
    "flank.js" SCRIPT,
    "variants.js" SCRIPT,
    "columns.js" SCRIPT,
);

/// All of them, those that reports draw with, too.
pub fn assets() -> impl Iterator<Item = Asset> {
    let shared = [
        ("uplot.js", SCRIPT, UPLOT_SCRIPT),
        ("uplot.css", STYLE, UPLOT_STYLE),
        ("three.module.min.js", SCRIPT, THREE_MODULE),
        ("three.core.min.js", SCRIPT, THREE_CORE),
        ("drawing.js", SCRIPT, DRAWING_SCRIPT),
        ("drawing.css", STYLE, DRAWING_STYLE),
        ("view3d.js", SCRIPT, VIEW_3D),
        ("scene3d.js", SCRIPT, SCENE_3D),
    ];
    let shared = shared.map(|(name, kind, text)| Asset { name, kind, text });
    OWN.into_iter().chain(shared)
}

/// The asset of a name.
pub fn asset(name: &str) -> Option<Asset> {
    assets().find(|asset| asset.name == name)
}

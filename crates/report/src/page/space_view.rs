//! Bodies in space that the reader turns, drawn by the modules that draw them in the studio
//! (docs/decisions/0030-space-in-reports.md).

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};

use super::packed::base64;

/// three 0.184.0 as published, its core and what draws: for other pages than these.
pub const THREE_CORE: &str = include_str!("../../assets/three.core.min.js");
/// See [`THREE_CORE`].
pub const THREE_MODULE: &str = include_str!("../../assets/three.module.min.js");
/// A canvas with a scene that a hand turns.
pub const VIEW_3D: &str = include_str!("../../assets/view3d.js");
/// A pair of gears in it.
pub const SCENE_3D: &str = include_str!("../../assets/scene3d.js");
const THREE_LICENCE: &str = include_str!("../../assets/three-LICENSE.txt");

/// Bodies in space. The data is what the module that draws them asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceView {
    title: String,
    data: Value,
}

impl SpaceView {
    /// A picture of `data`, which `assets/space.js` unpacks.
    pub fn new(title: impl Into<String>, data: Value) -> Self {
        Self {
            title: title.into(),
            data,
        }
    }

    pub(super) fn title(&self) -> &str {
        &self.title
    }

    pub(super) fn data(&self) -> &Value {
        &self.data
    }
}

/// The modules for the page: names and texts as JSON, compressed to a quarter, in base64.
pub(super) fn modules() -> String {
    let texts = json!({
        "three.core.min.js": THREE_CORE,
        "three.module.min.js": THREE_MODULE,
        "drawing.js": super::DRAWING_SCRIPT,
        "view3d.js": VIEW_3D,
        "scene3d.js": SCENE_3D,
    });
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    // Writing to memory does not fail.
    let bytes = (packed.write_all(texts.to_string().as_bytes())).and_then(|()| packed.finish());
    let packed = base64(&bytes.unwrap_or_default());
    format!(
        "<script>\n/* three 0.184.0, packed below\n{THREE_LICENCE}*/\n</script>\n<script type=\"text/plain\" id=\"modules\">{packed}</script>\n"
    )
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::{Block, Page, Section, Text};
    use super::*;
    use base64::Engine as _;

    /// Only a page with bodies in space carries three, and only there a script may come out of a blob. What it
    /// carries is what was published.
    #[test]
    fn bodies_in_space_bring_their_modules() {
        let section = |block: Block| Section {
            heading: "s".into(),
            blocks: vec![block],
        };
        let page = |block: Block| Page::new("t").section(section(block)).render().unwrap();
        let without = page(Text::paragraph("words").into());
        let with = page(SpaceView::new("gears", json!({"gears": []})).into());
        assert!(!without.contains("blob:;") && !without.contains("id=\"modules\""));
        assert!(with.contains("script-src 'unsafe-inline' blob:; img-src"));
        for forbidden in ["src=", "@import", "url(", "fetch(", "<link"] {
            assert!(!with.contains(forbidden), "{forbidden}");
        }
        let (_, packed) = with.split_once("id=\"modules\">").unwrap();
        let (packed, _) = packed.split_once('<').unwrap();
        let packed = base64::engine::general_purpose::STANDARD
            .decode(packed)
            .unwrap();
        let unpacked = flate2::read::GzDecoder::new(&packed[..]);
        let texts: Value = serde_json::from_reader(unpacked).unwrap();
        assert_eq!(texts["three.core.min.js"], THREE_CORE);
        assert_eq!(texts["three.module.min.js"], THREE_MODULE);
        // All that they import is there.
        for (name, text) in texts.as_object().unwrap() {
            let text = text.as_str().unwrap().replace("from \"./", "from\"./");
            for named in text.split("from\"./").skip(1) {
                let named = named.split('"').next().unwrap();
                assert!(texts.get(named).is_some(), "{name}: {named}");
            }
        }
        assert!(
            with.len() - without.len() < 300_000,
            "{}",
            with.len() - without.len()
        );
    }
}

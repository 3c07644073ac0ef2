//! A report as one HTML file that opens without a network.
//!
//! Style, script and data are inside the file: the numbers as base64 of 32-bit floats, the charts drawn by uPlot (MIT,
//! vendored in assets/ with its licence), the field pictures by a small rasteriser on a canvas, bodies in space by
//! three (MIT), which only pages with such a picture carry. A content security policy in the page forbids every
//! request. All texts are escaped.

mod checks;
mod error;
mod field_picture;
mod flank_chart;
mod line_chart;
mod map_chart;
mod markup;
pub(crate) mod packed;
mod path_chart;
mod polar_chart;
mod scatter_chart;
mod space_view;
mod spectrum_chart;
mod table;
mod text;
mod typography;

pub use error::PageError;
pub use field_picture::{FieldPicture, FieldValues, Mark, MarkSign, ViewWindow};
pub use flank_chart::FlankChart;
pub use line_chart::{Axis, AxisScale, LineChart, LineSeries, LineStyle, SeriesColour};
pub use map_chart::MapChart;
pub use path_chart::PathChart;
pub use polar_chart::PolarChart;
pub use scatter_chart::{PointSeries, ScatterChart};
pub use space_view::{SCENE_3D, SpaceView, THREE_CORE, THREE_MODULE, VIEW_3D};
pub use spectrum_chart::{SpectrumChart, SpectrumSeries};
pub use table::{Align, KeyFigures, Table};
pub use text::Text;

use markup::{escape, json_for_script};
use std::fmt::Write as _;
use typography::{html, plain};

const STYLE: &str = include_str!("../assets/page.css");
const CHART_SCRIPT: &str = include_str!("../assets/charts.js");
const DOWNLOAD_SCRIPT: &str = include_str!("../assets/download.js");
const FIELD_SCRIPT: &str = include_str!("../assets/field.js");
const PAGE_SCRIPT: &str = include_str!("../assets/page.js");
const SPACE_SCRIPT: &str = include_str!("../assets/space.js");
/// What drawings of all pages share, those of the studio among them: a module, colours, numbers, axes, legends.
pub const DRAWING_SCRIPT: &str = include_str!("../assets/drawing.js");
/// Its colours as a style.
pub const DRAWING_STYLE: &str = include_str!("../assets/drawing.css");
/// uPlot, as published: for other pages than these.
pub const UPLOT_SCRIPT: &str = include_str!("../assets/uPlot-1.6.32.iife.min.js");
/// Its style.
pub const UPLOT_STYLE: &str = include_str!("../assets/uPlot-1.6.32.min.css");
const UPLOT_LICENCE: &str = include_str!("../assets/uPlot-LICENSE.txt");

/// Something in a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A paragraph, a note or preformatted text.
    Text(Text),
    /// A few large figures.
    KeyFigures(KeyFigures),
    /// A table.
    Table(Table),
    /// Curves over a common abscissa.
    LineChart(LineChart),
    /// Stems over orders, logarithmic.
    SpectrumChart(SpectrumChart),
    /// A coloured plane mesh.
    FieldPicture(FieldPicture),
    /// Bars round a circle.
    PolarChart(PolarChart),
    /// A path in a plane.
    PathChart(PathChart),
    /// A tooth flank with what touches on it.
    FlankChart(FlankChart),
    /// Colours over two axes.
    MapChart(MapChart),
    /// Points over two axes.
    ScatterChart(ScatterChart),
    /// Bodies in space.
    SpaceView(SpaceView),
}

macro_rules! block_from {
    ($($kind:ident),*) => { $(
        impl From<$kind> for Block {
            fn from(block: $kind) -> Self {
                Self::$kind(block)
            }
        }
    )* };
}
block_from!(
    Text,
    KeyFigures,
    Table,
    LineChart,
    SpectrumChart,
    FieldPicture,
    PolarChart,
    PathChart,
    FlankChart,
    MapChart,
    ScatterChart,
    SpaceView
);

/// A heading and what stands under it.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    heading: String,
    blocks: Vec<Block>,
}

impl Section {
    /// An empty section.
    pub fn new(heading: impl Into<String>) -> Self {
        Self {
            heading: heading.into(),
            blocks: Vec::new(),
        }
    }

    /// Adds a block at the end.
    #[must_use]
    pub fn push(mut self, block: impl Into<Block>) -> Self {
        self.blocks.push(block.into());
        self
    }

    /// Adds blocks at the end.
    #[must_use]
    pub fn push_all<B: Into<Block>>(self, blocks: impl IntoIterator<Item = B>) -> Self {
        blocks.into_iter().fold(self, Self::push)
    }
}

/// A report page.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    title: String,
    subtitle: Option<String>,
    sections: Vec<Section>,
    footer: Option<String>,
}

impl Page {
    /// A page with a title and nothing else.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            subtitle: None,
            sections: Vec::new(),
            footer: None,
        }
    }

    /// One line under the title.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = Some(subtitle.into());
        self
    }

    /// One line at the end: version, date, input files.
    #[must_use]
    pub fn footer(mut self, footer: impl Into<String>) -> Self {
        self.footer = Some(footer.into());
        self
    }

    /// Puts a section before all others.
    #[must_use]
    pub fn first_section(mut self, section: Section) -> Self {
        self.sections.insert(0, section);
        self
    }

    /// Adds a section at the end.
    #[must_use]
    pub fn section(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }

    /// The page as HTML text (UTF-8).
    ///
    /// # Errors
    /// [`PageError`]: the block, what was found and what is expected.
    pub fn render(&self) -> Result<String, PageError> {
        let mut page = String::new();
        let mut blocks = self.sections.iter().flat_map(|section| &section.blocks);
        let in_space = blocks.any(|block| matches!(block, Block::SpaceView(_)));
        // Modules that the page itself unpacks.
        let more = if in_space { " blob:" } else { "" };
        let _ = write!(
            page,
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; \
             script-src 'unsafe-inline'{more}; img-src data:\">\n<title>{}</title>\n\
             <style>{UPLOT_STYLE}\n{DRAWING_STYLE}\n{STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{}</h1>\n",
            escape(&plain(&self.title)),
            html(&self.title)
        );
        if let Some(subtitle) = &self.subtitle {
            let _ = writeln!(page, "<p class=\"subtitle\">{}</p>", html(subtitle));
        }
        page.push_str("</header>\n");
        // A heading with nothing below it says nothing.
        let sections = || {
            let sections = self.sections.iter().enumerate();
            sections.filter(|(_, section)| !section.blocks.is_empty())
        };
        self.navigation(&mut page, sections());
        page.push_str("<main>\n");
        for (i, section) in sections() {
            let _ = writeln!(
                page,
                "<section id=\"s{i}\">\n<h2>{}</h2>",
                html(&self.heading(section))
            );
            for block in &section.blocks {
                render_block(&mut page, block)?;
            }
            page.push_str("</section>\n");
        }
        page.push_str("</main>\n");
        if let Some(footer) = &self.footer {
            let _ = writeln!(page, "<footer>{}</footer>", html(footer));
        }
        if in_space {
            page.push_str(&space_view::modules());
        }
        // In one scope nothing is exported.
        let drawing = DRAWING_SCRIPT.replace("\nexport ", "\n");
        let _ = write!(
            page,
            "<script>\n/* uPlot 1.6.32\n{UPLOT_LICENCE}*/\n{UPLOT_SCRIPT}\n</script>\n\
             <script>\n\"use strict\";\n{drawing}\n{PAGE_SCRIPT}\n{DOWNLOAD_SCRIPT}\n{CHART_SCRIPT}\n{FIELD_SCRIPT}\n{SPACE_SCRIPT}\n</script>\n</body>\n</html>\n"
        );
        Ok(page)
    }

    /// A heading without what stands above it already: the title of the page.
    fn heading<'a>(&'a self, section: &'a Section) -> String {
        if section.heading == self.title {
            return "At a glance".to_owned();
        }
        let rest = section.heading.strip_prefix(&self.title[..]);
        match rest.and_then(|rest| rest.strip_prefix(": ")) {
            Some(rest) => capital(rest),
            None => section.heading.clone(),
        }
    }

    fn navigation<'a>(
        &'a self,
        page: &mut String,
        sections: impl Iterator<Item = (usize, &'a Section)>,
    ) {
        page.push_str("<nav aria-label=\"Sections\"><ul>");
        for (i, section) in sections {
            let heading = html(&self.heading(section));
            let _ = write!(page, "<li><a href=\"#s{i}\">{heading}</a></li>");
        }
        page.push_str("</ul><button type=\"button\" id=\"theme\" hidden>Dark</button></nav>\n");
    }
}

/// With a capital letter in front.
pub fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|letter| letter.to_uppercase());
    first.into_iter().flatten().chain(letters).collect()
}

fn render_block(page: &mut String, block: &Block) -> Result<(), PageError> {
    match block {
        Block::Text(text) => text.render(page),
        Block::KeyFigures(figures) => figures.render(page),
        Block::Table(table) => table.render(page)?,
        Block::PolarChart(chart) => chart.render(page)?,
        Block::PathChart(chart) => chart.render(page)?,
        Block::FlankChart(chart) => chart.render(page)?,
        Block::MapChart(chart) => chart.render(page)?,
        Block::ScatterChart(chart) => chart.render(page)?,
        Block::LineChart(chart) => render_figure(page, "line", chart.title(), &chart.payload()?)?,
        Block::SpectrumChart(chart) => {
            render_figure(page, "spectrum", chart.title(), &chart.payload()?)?
        }
        Block::SpaceView(view) => render_figure(page, "space", view.title(), view.data())?,
        Block::FieldPicture(picture) => {
            render_figure(page, "field", picture.title(), &picture.payload()?)?
        }
    }
    Ok(())
}

/// A figure that the script fills from its payload.
fn render_figure(
    page: &mut String,
    kind: &str,
    title: &str,
    payload: &serde_json::Value,
) -> Result<(), PageError> {
    let json = json_for_script(payload).map_err(|e| PageError::Data {
        block: title.to_string(),
        reason: e.to_string(),
    })?;
    let _ = write!(
        page,
        "<figure class=\"chart\" data-kind=\"{kind}\">\n<figcaption>{}</figcaption>\n<div class=\"drawing\"></div>\n\
         <noscript>This figure needs JavaScript.</noscript>\n<script type=\"application/json\">{json}</script>\n</figure>\n",
        html(title)
    );
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn chart(title: &str) -> LineChart {
        LineChart::new(title, Axis::new("x", "deg"), Axis::new("y", "µm"))
            .x_values((0..100).map(f64::from).collect())
            .series(LineSeries::new(title, vec![1.0; 100]))
    }

    #[test]
    fn nothing_is_fetched() {
        let html = Page::new("t")
            .section(Section::new("s").push(chart("c")))
            .render()
            .unwrap();
        for forbidden in [
            "src=",
            "@import",
            "url(",
            "fetch(",
            "XMLHttpRequest",
            "<link",
        ] {
            assert!(!html.contains(forbidden), "{forbidden}");
        }
        assert!(html.contains("default-src 'none'") && html.contains("Leon Sorokin"));
    }

    #[test]
    fn texts_are_escaped_everywhere() {
        let evil = "</script><script>alert('x')</script>&\"<!--";
        let picture = FieldPicture::new(evil, evil, evil)
            .mesh(
                vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
                vec![[0, 1, 2, 3]],
            )
            .values(FieldValues::PerElement(vec![1.0]));
        let spectrum = SpectrumChart::new(evil, Axis::new(evil, evil))
            .orders(vec![0.0, 1.0])
            .series(SpectrumSeries::new(evil, vec![1.0, 2.0]))
            .highlight(1.0, evil);
        let section = Section::new(evil)
            .push(Text::paragraph(evil))
            .push(Text::note(evil))
            .push(Text::preformatted(evil))
            .push(KeyFigures::new().figure(evil, evil, evil))
            .push(Table::new(evil).column(evil, Align::Left).row([evil]))
            .push(chart(evil))
            .push(
                PolarChart::new(evil, evil)
                    .angles_rad(vec![0.0])
                    .series(evil, vec![1.0]),
            )
            .push(PathChart::new(evil, evil, vec![[1.0, 2.0]]))
            .push(
                FlankChart::new(evil, vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
                    .line(evil, vec![[0.1, 0.1]]),
            )
            .push(spectrum)
            .push(picture);
        let html = Page::new(evil)
            .subtitle(evil)
            .footer(evil)
            .section(section)
            .render()
            .unwrap();
        assert!(
            !html.contains("alert('x')")
                && !html.contains("<!--")
                && !html.contains("<script>alert")
        );
        // Two programs and three payloads, nothing else.
        assert_eq!(html.matches("<script").count(), 5);
        assert_eq!(html.matches("</script").count(), 5);
    }

    #[test]
    fn a_large_page_stays_below_three_megabytes() {
        let mut section = Section::new("s");
        for _ in 0..3 {
            let mut c = LineChart::new("c", Axis::new("x", "deg"), Axis::new("y", "µm"))
                .x_values((0..2300).map(f64::from).collect());
            for k in 0..12 {
                c = c.series(LineSeries::new(
                    format!("{k}"),
                    (0..2300).map(|i| f64::from(i * k).sin()).collect(),
                ));
            }
            section = section.push(c);
        }
        let (columns, rows) = (301, 101);
        let nodes = (0..columns * rows)
            .map(|i| [f64::from(i % columns), f64::from(i / columns)])
            .collect::<Vec<_>>();
        let quads: Vec<[u32; 4]> = (0..(rows - 1) as u32)
            .flat_map(|r| (0..(columns - 1) as u32).map(move |c| r * columns as u32 + c))
            .map(|n| [n, n + 1, n + 1 + columns as u32, n + columns as u32])
            .collect();
        assert_eq!(quads.len(), 30_000);
        for _ in 0..2 {
            let values = (0..nodes.len()).map(|i| (i as f64).cos()).collect();
            section = section.push(
                FieldPicture::new("p", "q", "MPa")
                    .mesh(nodes.clone(), quads.clone())
                    .values(FieldValues::PerNode(values)),
            );
        }
        let html = Page::new("large").section(section).render().unwrap();
        assert!(html.len() < 3_000_000, "{}", html.len());
    }

    #[test]
    fn errors_name_the_block() {
        let render = |block: Block| {
            let section = Section {
                heading: "s".into(),
                blocks: vec![block],
            };
            Page::new("t").section(section).render().unwrap_err()
        };
        let short = chart("c").series(LineSeries::new("short", vec![0.0]));
        assert_eq!(
            render(short.into()).to_string(),
            "'c': series 'short' has 1 entries; 100 are expected"
        );
        let repeated = chart("c").x_values(vec![1.0; 100]);
        assert!(matches!(
            render(repeated.into()),
            PageError::NotIncreasing { index: 1, .. }
        ));
        let row = Table::new("t").column("a", Align::Left).row(["1", "2"]);
        assert!(matches!(
            render(row.into()),
            PageError::Count {
                found: 2,
                expected: 1,
                ..
            }
        ));
        let picture = FieldPicture::new("p", "q", "MPa")
            .mesh(vec![[0.0; 2]; 4], vec![[0, 1, 2, 4]])
            .values(FieldValues::PerElement(vec![1.0]));
        assert!(matches!(
            render(picture.into()),
            PageError::NoSuchNode { node: 4, .. }
        ));
    }

    proptest! {
        #[test]
        fn any_text_leaves_the_structure_alone(text in any::<String>()) {
            let html = Page::new(&text).section(Section::new(&text).push(Text::paragraph(&text)).push(chart(&text))).render().unwrap();
            prop_assert_eq!(html.matches("<script").count(), 3);
            prop_assert_eq!(html.matches("<section").count(), 1);
        }
    }
}

//! Writes a page with every kind of block, to look at: made-up curves and a made-up stress field.
//!
//! `cargo run -p gearmesh-report --example sample_page -- sample.html`

use gearmesh_report::page::{
    Align, Axis, AxisScale, FieldPicture, FieldValues, KeyFigures, LineChart, LineSeries,
    LineStyle, Page, PageError, Section, SeriesColour, SpectrumChart, SpectrumSeries, Table, Text,
    ViewWindow,
};
use gearmesh_signal::OrderSpectrum;
use std::f64::consts::TAU;
use std::process::ExitCode;

const TEETH: usize = 57;
const POINTS: usize = 2280;
const TORQUES_NM: [f64; 6] = [50.0, 100.0, 150.0, 200.0, 250.0, 300.0];

fn main() -> ExitCode {
    let Some(path) = std::env::args().nth(1) else {
        eprintln_usage();
        return ExitCode::from(2);
    };
    match page().map(|html| std::fs::write(&path, html)) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

#[allow(
    clippy::print_stderr,
    reason = "an example talks to the person who runs it"
)]
fn eprintln_usage() {
    eprintln!("usage: sample_page OUTPUT.html");
}

/// A made-up transmission error in µm: the mean falls with the torque, two pairs and one pair alternate.
fn te_um(angle_rad: f64, torque_nm: f64, ours: bool) -> f64 {
    let phase = (angle_rad * TEETH as f64 / TAU).rem_euclid(1.0);
    let double = 1.0 / (1.0 + (40.0 * ((phase - 0.5).abs() - 0.32)).exp());
    let scale = if ours { 1.0 } else { 1.02 };
    -scale * torque_nm * (0.16 - 0.035 * double) - 1.5 * (3.0 * angle_rad).cos() * torque_nm / 300.0
}

fn te_chart(title: &str) -> LineChart {
    let degrees: Vec<f64> = (0..POINTS)
        .map(|i| 360.0 * i as f64 / POINTS as f64)
        .collect();
    let mut chart = LineChart::new(
        title,
        Axis::new("driver angle", "deg"),
        Axis::new("transmission error", "µm"),
    );
    for (k, torque) in TORQUES_NM.iter().enumerate() {
        let colour = SeriesColour::Ramp(k as f64 / 5.0);
        for ours in [true, false] {
            let values = degrees
                .iter()
                .map(|d| te_um(d.to_radians(), *torque, ours))
                .collect();
            let name = format!(
                "{torque} N·m {}",
                if ours { "gearmesh" } else { "reference" }
            );
            let style = if ours {
                LineStyle::Solid
            } else {
                LineStyle::Dashed
            };
            chart = chart.series(LineSeries::new(name, values).colour(colour).style(style));
        }
    }
    chart.x_values(degrees)
}

fn spectrum_chart() -> SpectrumChart {
    let of = |ours| {
        let values: Vec<f64> = (0..POINTS)
            .map(|i| te_um(TAU * i as f64 / POINTS as f64, 300.0, ours))
            .collect();
        OrderSpectrum::from_samples(&values, 1)
    };
    let mut chart = SpectrumChart::new(
        "Order spectrum of the TE, 300 N·m",
        Axis::new("amplitude", "µm"),
    )
    .up_to_order(300.0);
    for (name, ours) in [("gearmesh", true), ("reference", false)] {
        if let Ok(spectrum) = of(ours) {
            let mut amplitudes = spectrum.amplitudes();
            amplitudes[0] = 0.0;
            chart = chart
                .orders(spectrum.orders())
                .series(SpectrumSeries::new(name, amplitudes));
        }
    }
    chart
        .highlight(3.0, "slots")
        .highlight(57.0, "mesh")
        .highlight(114.0, "2 × mesh")
        .highlight(171.0, "")
        .highlight(228.0, "")
}

/// A ring with teeth: 25 rows of 1140 quads, a stress that is largest at one tooth root.
fn picture(per_node: bool) -> FieldPicture {
    let (around, rows) = (1140usize, 25usize);
    let mut nodes = Vec::new();
    let mut values = Vec::new();
    for r in 0..=rows {
        for i in 0..around {
            let angle = TAU * i as f64 / around as f64;
            let tooth = 3.0 * (3.0 * (TEETH as f64 * angle).cos()).tanh();
            let depth = r as f64 / rows as f64;
            let radius = 60.0 + depth * (14.7 + tooth * depth);
            let (x, y) = (radius * angle.cos(), radius * angle.sin());
            nodes.push([x, y]);
            let near = |x0: f64, y0: f64, width: f64| {
                (-((x - x0).powi(2) + (y - y0).powi(2)) / width.powi(2)).exp()
            };
            values.push(
                20.0 + 310.0 * near(71.6, 3.9, 1.6)
                    + 250.0 * near(71.6, -3.9, 1.4)
                    + 60.0 * near(66.0, 0.0, 8.0),
            );
        }
    }
    let node = |r: usize, i: usize| (r * around + i % around) as u32;
    let quads: Vec<[u32; 4]> = (0..rows)
        .flat_map(|r| {
            (0..around).map(move |i| {
                [
                    node(r, i),
                    node(r, i + 1),
                    node(r + 1, i + 1),
                    node(r + 1, i),
                ]
            })
        })
        .collect();
    let values = if per_node {
        FieldValues::PerNode(values)
    } else {
        FieldValues::PerElement(
            quads
                .iter()
                .map(|q| q.iter().map(|n| values[*n as usize]).sum::<f64>() / 4.0)
                .collect(),
        )
    };
    let title = if per_node {
        "Von Mises stress at mid-face, 300 N·m"
    } else {
        "The same near tooth 0, by element, scale cut at 250 MPa"
    };
    FieldPicture::new(title, "von Mises", "MPa")
        .mesh(nodes, quads)
        .values(values)
}

fn page() -> Result<String, PageError> {
    let near_tooth = ViewWindow {
        centre_mm: [72.0, 0.0],
        width_mm: 28.0,
    };
    let mut table = Table::new("Transmission error against the reference")
        .column("Torque [N·m]", Align::Right)
        .column("Mean [µm]", Align::Right)
        .column("Reference [µm]", Align::Right)
        .column("Peak-to-peak [µm]", Align::Right)
        .column("Remark", Align::Left);
    for torque in TORQUES_NM {
        table = table.row([
            format!("{torque}"),
            format!("{:.2}", -0.137 * torque),
            format!("{:.2}", -0.140 * torque),
            format!("{:.2}", 0.036 * torque),
            if torque < 60.0 {
                "crowning rules <here> & now".into()
            } else {
                String::new()
            },
        ]);
    }
    let decay = LineChart::new(
        "Residual of the contact solver",
        Axis::new("iteration", ""),
        Axis::new("residual", "m"),
    )
    .y_scale(AxisScale::Logarithmic)
    .x_values((0..12).map(f64::from).collect())
    .series(LineSeries::new(
        "Newton",
        (0..12)
            .map(|i| 1e-5 * 10f64.powf(-0.12 * f64::from(i * i)))
            .collect(),
    ))
    .series(
        LineSeries::new(
            "projected",
            (0..12)
                .map(|i| 1e-5 * 10f64.powf(-0.4 * f64::from(i)))
                .collect(),
        )
        .style(LineStyle::Dotted),
    )
    .series(LineSeries::new("off at first", vec![1e-7; 12]).hidden());
    Page::new("Gear pair B: solid gear 1 and slotted gear 3")
        .subtitle("A sample of every block; the numbers are made up.")
        .section(
            Section::new("Key figures")
                .push(
                    KeyFigures::new()
                        .figure("Mean mesh stiffness c_γ", "14.2", "N/(mm·µm)")
                        .figure("TE peak-to-peak at 300 N·m", "10.8", "µm")
                        .figure("Largest root strain", "812", "µε")
                        .figure("Largest Hertz pressure", "1.13", "GPa"),
                )
                .push(Text::paragraph("Both sides went through the same rig pipeline: 51.2 kHz, 10 rpm, 5000 pulses a turn, spectra of ten revolutions averaged, orders 0 and 1 of the transmission error removed."))
                .push(Text::note("The reference is computed, not measured. Bore, hub and slots of the source are not given and were assumed."))
                .push(table),
        )
        .section(
            Section::new("Transmission error")
                .push(te_chart("One revolution"))
                .push(te_chart("Three pitches").x_window(0.0, 3.0 * 360.0 / TEETH as f64))
                .push(spectrum_chart()),
        )
        .section(
            Section::new("Stress")
                .push(picture(true))
                .push(picture(false).colour_range(0.0, 250.0).window(near_tooth)),
        )
        .section(Section::new("Solver").push(decay).push(Text::preformatted("$ gearmesh run scene.toml -o result.h5\n1368 angles, 6 torques")))
        .footer("gearmesh 0.1.0 · sample")
        .render()
}

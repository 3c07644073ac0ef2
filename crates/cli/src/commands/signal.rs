//! `gearmesh signal`: what a reader of vibration does with a column of a result.

mod bearing_lines;
mod outcome;
mod series;

use crate::arguments::{AbscissaArguments, SignalAnalysis, SignalArguments};
use crate::console;
use bearing_lines::BearingLines;
use gearmesh_model::Column;
use gearmesh_operations::{Failure, overwriting};
use gearmesh_report::column_width;
use gearmesh_report::page::{Axis, MapChart};
use gearmesh_signal::statistics::{crest_factor, kurtosis, mean, peak_to_peak, rms};
use gearmesh_signal::{
    Band, OrderBlocks, Resampler, SidebandSettings, Spectrum, Window, amplitude_spectrum, envelope,
    sideband_table, synchronous_average,
};
use outcome::{Curve, LineSpectrum, Outcome};
use serde_json::json;
use series::{Form, Series, open};
use std::f64::consts::TAU;
use std::path::Path;

/// The result that is read is never the file that is written.
fn refuse_overwriting(analysis: &SignalAnalysis) -> Result<(), Failure> {
    match analysis.series() {
        None => Ok(()),
        Some(of) => overwriting::refuse(vec![of.result.clone()], of.output.as_slice()),
    }
}

/// Runs the command.
pub fn run(a: &SignalArguments) -> Result<(), Failure> {
    refuse_overwriting(&a.analysis)?;
    match &a.analysis {
        SignalAnalysis::Columns { result, json } => columns(result, *json),
        SignalAnalysis::Statistics { series } => {
            statistics(&Series::read(series, None, Form::Instants)?).finish(series)
        }
        SignalAnalysis::Spectrum {
            series,
            abscissa,
            peaks,
        } => {
            let read = Series::over(series, abscissa)?;
            let spectrum = spectrum(&read, &read.values, abscissa)?;
            let mut outcome = spectrum_outcome(&read, "spectrum", &spectrum);
            outcome.list_peaks(&spectrum, *peaks);
            outcome.finish(series)
        }
        SignalAnalysis::Sidebands {
            series,
            abscissa,
            carrier,
            modulator,
            pairs,
            search_lines,
        } => {
            let read = Series::over(series, abscissa)?;
            let settings = SidebandSettings {
                carrier: *carrier,
                modulator: *modulator,
                pairs: *pairs,
                search_lines: *search_lines,
            };
            sidebands(&read, &spectrum(&read, &read.values, abscissa)?, settings)?.finish(series)
        }
        SignalAnalysis::Envelope {
            series,
            abscissa,
            low,
            high,
            edge,
            peaks,
            bearing,
        } => {
            let lines = BearingLines::read(bearing, abscissa.shaft.is_some())?;
            let band = Band {
                low: *low,
                high: *high,
                edge: edge.unwrap_or(0.1 * (high - low)),
            };
            let read = Series::over(series, abscissa)?;
            band_envelope(&read, band, (abscissa, *peaks), lines.as_ref())?.finish(series)
        }
        SignalAnalysis::Average {
            series,
            shaft,
            periods_per_turn,
        } => {
            let read = Series::read(series, Some((&shaft.shaft, 1)), Form::LowPass)?;
            average(&read, shaft.samples_per_turn, *periods_per_turn)?.finish(series)
        }
        SignalAnalysis::Map {
            series,
            shaft,
            block_turns,
            step_turns,
            peaks,
        } => {
            let read = Series::read(series, Some((&shaft.shaft, *block_turns)), Form::LowPass)?;
            let blocks = OrderBlocks {
                samples_per_revolution: read.samples_per_turn(shaft.samples_per_turn)?,
                block_revolutions: *block_turns,
                step_revolutions: *step_turns,
                window: Window::Hann,
            };
            map(&read, blocks, *peaks)?.finish(series)
        }
    }
}

/// Lists the columns of a result.
fn columns(result: &Path, as_json: bool) -> Result<(), Failure> {
    let result = open(result)?;
    let columns = result.rows.columns().iter();
    if as_json {
        let each =
            |c: &Column| json!({ "name": c.name, "unit": c.unit, "description": c.description });
        console::json(&json!({ "columns": columns.map(each).collect::<Vec<_>>() }));
        return Ok(());
    }
    let width = column_width(columns.clone().map(|column| &column.name), 0);
    for Column {
        name,
        unit,
        description,
    } in columns
    {
        console::data(format!("{name:width$}  {unit:8}  {description}"));
    }
    Ok(())
}

/// Amplitudes of values at the places of a series over frequency or order, mean removed. Orders end where the
/// resampling is no longer right.
fn spectrum(
    series: &Series,
    values: &[f64],
    abscissa: &AbscissaArguments,
) -> Result<Spectrum, Failure> {
    let centre = mean(values).map_err(Failure::input)?;
    let centred: Vec<f64> = values.iter().map(|x| x - centre).collect();
    let window = series::window(abscissa);
    let mut found = amplitude_spectrum(&centred, series.rate, window).map_err(Failure::input)?;
    if abscissa.shaft.is_some() {
        found.values.truncate(right_lines(&found, series.rate));
    } else {
        let right = series.band * 0.5 * series.rate / found.line_spacing;
        found.values.truncate(right as usize + 1);
    }
    Ok(found)
}

/// Lines of orders that resampling keeps, for so many samples in a turn.
fn right_lines(spectrum: &Spectrum, per_turn: f64) -> usize {
    let highest = 0.5 * per_turn * Resampler::default().band();
    (highest / spectrum.line_spacing).floor() as usize + 1
}

/// An outcome that draws a spectrum.
fn spectrum_outcome(series: &Series, analysis: &'static str, spectrum: &Spectrum) -> Outcome {
    let mut outcome = Outcome::new(series, analysis);
    let places = (0..spectrum.values.len()).map(|line| spectrum.at(line));
    outcome.curves = vec![
        Curve::new(series.place, series.place_unit, places.collect()),
        Curve::new("amplitude", &series.unit, spectrum.values.clone()),
    ];
    outcome.is_logarithmic = true;
    outcome
}

fn sidebands(
    series: &Series,
    spectrum: &Spectrum,
    settings: SidebandSettings,
) -> Result<Outcome, Failure> {
    let table = sideband_table(spectrum, settings).map_err(Failure::input)?;
    let mut outcome = spectrum_outcome(series, "sidebands", spectrum);
    outcome.heads = ["number", series.place, "amplitude", "over the carrier"]
        .map(str::to_owned)
        .to_vec();
    for line in &table {
        let row = vec![f64::from(line.number), line.at, line.amplitude, line.ratio];
        outcome.rows.push(row);
    }
    let beside = table.iter().filter(|line| line.number != 0);
    let square: f64 = beside.map(|line| line.ratio.powi(2)).sum();
    let name = "sidebands over the carrier (root of the sum of squares)";
    outcome.figure(name, square.sqrt(), "");
    Ok(outcome)
}

fn band_envelope(
    series: &Series,
    band: Band,
    (abscissa, peaks): (&AbscissaArguments, usize),
    lines: Option<&BearingLines>,
) -> Result<Outcome, Failure> {
    let found = envelope(&series.values, series.rate, band).map_err(Failure::input)?;
    let mut outcome = Outcome::new(series, "envelope");
    let level = mean(&found.envelope).map_err(Failure::input)?;
    outcome.figure("mean of the envelope", level, &series.unit);
    let swing = peak_to_peak(&found.envelope).map_err(Failure::input)?;
    outcome.figure("peak to peak of the envelope", swing, &series.unit);
    let spiky = kurtosis(&found.filtered).unwrap_or(f64::NAN);
    outcome.figure("kurtosis of the band", spiky, "");
    let of_envelope = spectrum(series, &found.envelope, abscissa)?;
    outcome.list_peaks(&of_envelope, peaks);
    outcome.spectrum = Some(LineSpectrum::new(series, &of_envelope));
    if let Some(lines) = lines {
        lines.mark(&of_envelope, &mut outcome, &series.unit, series.place_unit);
    }
    outcome.curves = vec![
        series.abscissa(),
        Curve::new("band", &series.unit, found.filtered),
        Curve::new("envelope", &series.unit, found.envelope),
    ];
    Ok(outcome)
}

fn statistics(series: &Series) -> Outcome {
    let values = &series.values;
    let centre = mean(values).unwrap_or(f64::NAN);
    let centred: Vec<f64> = values.iter().map(|x| x - centre).collect();
    let mut outcome = Outcome::new(series, "statistics");
    let or_none = |value: Result<f64, _>| value.unwrap_or(f64::NAN);
    outcome.figure("mean", centre, &series.unit);
    outcome.figure("RMS", or_none(rms(values)), &series.unit);
    outcome.figure("RMS about the mean", or_none(rms(&centred)), &series.unit);
    outcome.figure("peak to peak", or_none(peak_to_peak(values)), &series.unit);
    outcome.figure("kurtosis", or_none(kurtosis(values)), "");
    outcome.figure(
        "crest factor about the mean",
        or_none(crest_factor(&centred)),
        "",
    );
    outcome.curves = vec![
        series.abscissa(),
        Curve::new(&series.column, &series.unit, values.clone()),
    ];
    outcome
}

/// Average over the periods of a shaft.
fn average(
    series: &Series,
    samples_per_turn: Option<usize>,
    periods_per_turn: usize,
) -> Result<Outcome, Failure> {
    let per_period = series.samples_per_turn(samples_per_turn)? / periods_per_turn.max(1);
    if periods_per_turn == 0 || per_period < 4 {
        return Err(Failure::input(format!(
            "--periods-per-turn: found {periods_per_turn}, which leaves {per_period} samples in a period; allowed is 1 or more with at least 4 samples each (shorten interval_s of the scene's [output], or give --samples-per-turn)"
        )));
    }
    let per_turn = per_period * periods_per_turn;
    let resampled = series.to_angle(per_turn)?;
    let periods = resampled.values.len() / per_period;
    let found =
        synchronous_average(&resampled.values, per_period, periods).map_err(Failure::input)?;
    let mut outcome = Outcome::new(series, "synchronous average");
    outcome.figure("periods averaged", found.periods as f64, "");
    let swing = peak_to_peak(&found.average).map_err(Failure::input)?;
    outcome.figure("peak to peak of the average", swing, &series.unit);
    let left = rms(&found.residual).map_err(Failure::input)?;
    outcome.figure("RMS of the residual", left, &series.unit);
    outcome.figure(
        "kurtosis of the residual",
        found.residual_kurtosis.unwrap_or(f64::NAN),
        "",
    );
    let step = TAU / per_turn as f64;
    let angle = |sample: usize| resampled.start_rad + sample as f64 * step;
    outcome.curves = vec![
        Curve::new("angle", "rad", (0..per_period).map(angle).collect()),
        Curve::new("average", &series.unit, found.average),
    ];
    Ok(outcome)
}

/// The last speed over the first one of a run-up at least.
const RUN_UP: f64 = 1.01;

/// Amplitudes of all orders, block by block.
fn map(series: &Series, blocks: OrderBlocks, peaks: usize) -> Result<Outcome, Failure> {
    let angles = series.angles()?;
    let turns = (angles[angles.len() - 1] - angles[0]) / TAU;
    if turns <= blocks.block_revolutions as f64 {
        return Err(Failure::input(format!(
            "--block-turns: found {}, but the series has {turns:.2} turns, the ends that resampling needs included; give fewer, or a longer \
             run.end_s in the scene",
            blocks.block_revolutions
        )));
    }
    let rows = gearmesh_signal::campbell::order_map(
        &series.values,
        angles,
        series.rate,
        blocks,
        &Resampler::default(),
    )
    .map_err(Failure::input)?;
    let Some(first) = rows.first() else {
        return Err(Failure::input("the series holds no whole block"));
    };
    let lines = right_lines(&first.spectrum, blocks.samples_per_revolution as f64);
    let largest = |line: usize| {
        rows.iter()
            .map(|row| row.spectrum.values[line])
            .fold(0.0, f64::max)
    };
    let envelope = Spectrum {
        values: (0..lines).map(largest).collect(),
        line_spacing: first.spectrum.line_spacing,
    };
    let mut outcome = Outcome::new(series, "order map");
    outcome.figure("blocks", rows.len() as f64, "");
    let rpm = |speed: f64| speed * 60.0 / TAU;
    outcome.heads = ["order", "largest amplitude", "at rpm"]
        .map(str::to_owned)
        .to_vec();
    for (line, amplitude) in outcome::peaks(&envelope, peaks) {
        let at = rows
            .iter()
            .find(|row| row.spectrum.values[line] == amplitude);
        let speed = at.map_or(f64::NAN, |row| rpm(row.speed_rad_per_s));
        outcome.rows.push(vec![envelope.at(line), amplitude, speed]);
    }
    let speeds: Vec<f64> = rows.iter().map(|row| rpm(row.speed_rad_per_s)).collect();
    let times: Vec<f64> = rows.iter().map(|row| series.start_s + row.time_s).collect();
    outcome.curves = vec![
        Curve::new("speed", "rpm", speeds.clone()),
        Curve::new("time", "s", times.clone()),
    ];
    for line in 0..lines {
        let values = rows.iter().map(|row| row.spectrum.values[line]);
        let name = format!("order {}", envelope.at(line));
        let curve = Curve::new(&name, &series.unit, values.collect());
        outcome.curves.push(curve);
    }
    // Over the speed in a run-up, over time otherwise: a constant speed rises by rounding, too.
    let rises = rows
        .windows(2)
        .all(|pair| pair[1].speed_rad_per_s > pair[0].speed_rad_per_s);
    let ends = [first, &rows[rows.len() - 1]].map(|row| row.speed_rad_per_s);
    let (over, along, axis) = if rises && ends[1] > RUN_UP * ends[0] {
        ("speed", speeds, Axis::new("speed", "rpm"))
    } else {
        ("time", times, Axis::new("time", "s"))
    };
    let columns = rows.iter().map(|row| row.spectrum.values[..lines].to_vec());
    let chart = MapChart::new(
        format!("{}: orders over the {over}", series.column),
        axis,
        Axis::new("order", ""),
        Axis::new("amplitude", series.unit.clone()),
    );
    outcome.map = Some(chart.values(along, envelope.line_spacing, columns.collect()));
    Ok(outcome)
}

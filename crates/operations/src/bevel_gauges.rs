//! Root strain at the gauges of a loaded bevel pair, over the passage of the gauged tooth through the mesh.
//!
//! The positions of a load cover one pitch. A pitch later the next teeth stand where these stood and carry what these carried, so that one tooth's passage is put
//! together from all teeth in contact.

use gearmesh_contact::bevel_slices::spread_from_heel;
use gearmesh_drivetrain::{LoadedContact, LoadedPatch};
use gearmesh_geometry::Flank;
use gearmesh_model::{ReducedGear, ReducedGearError};
use gearmesh_recovery::{GaugeArray, LoadedSlice, Strain};
use gearmesh_report::page::{Align, Table};
use serde_json::{Value, json};

/// Pitches before and after the one that was loaded: no tooth is longer in mesh.
const PITCHES: i32 = 4;

/// The members, as they are called.
const MEMBERS: [&str; 2] = ["pinion", "gear"];

/// Strain at one gauge under one torque.
pub struct GaugeStrain {
    /// Member 0 or 1.
    member: usize,
    name: String,
    tooth: usize,
    torque_nm: f64,
    /// Turn of the pinion \[rad\], counted as if the gauged tooth were the one with its mean point in the plane of the axes at 0, and strain.
    series: Vec<(f64, Strain)>,
}

impl GaugeStrain {
    /// Least and largest strain \[µε\] by method 1 or 2.
    fn range(&self, method: fn(&Strain) -> f64) -> [f64; 2] {
        let values = self
            .series
            .iter()
            .map(|(_, strain)| 1e6 * method(strain) + 0.0);
        let least = values.clone().fold(f64::INFINITY, f64::min);
        [least, values.fold(f64::NEG_INFINITY, f64::max)]
    }

    fn shown(&self, method: fn(&Strain) -> f64) -> String {
        let [least, most] = self.range(method);
        format!("{least:.1} to {most:.1}")
    }
}

const METHODS: [fn(&Strain) -> f64; 2] = [|s| s.method_1, |s| s.method_2];

/// Reads all gauges of both members under all torques; `slices` of gear 1's face, `face_1_m` wide.
///
/// # Errors
/// [`ReducedGearError`] where a model carries no loads on this side of the teeth.
pub fn read(
    models: [&ReducedGear; 2],
    side: Flank,
    (slices, face_1_m): (usize, f64),
    found: &[LoadedContact],
) -> Result<Vec<GaugeStrain>, ReducedGearError> {
    let mut all = Vec::new();
    for (member, model) in models.iter().enumerate() {
        let spread = spread_from_heel(model, face_1_m, slices);
        for gauge in &model.gauges {
            let row = GaugeArray::new(model, std::iter::once(gauge), side, &spread)?;
            for of in found {
                let strain = |shift: i32, patches: &[LoadedPatch]| {
                    let mut strain = [Strain::default()];
                    // Where the pinion has turned on by a pitch, a tooth of its own number less one stands in the same place, of the gear one more.
                    let on = i64::from(if member == 0 { -shift } else { shift });
                    for patch in patches {
                        let [_, up] = patch.places[member];
                        let tooth = patch.teeth[member] as i64 + on + gauge.tooth as i64;
                        let slice = (patch.places[0][0] * slices as f64) as usize;
                        let loaded = LoadedSlice {
                            tooth: tooth.rem_euclid(model.teeth as i64) as usize,
                            slice: slice.min(slices - 1),
                            roll_rad: up,
                            components: [1.0, 0.0],
                            force_n: patch.force_n,
                        };
                        row.add(&loaded, &row.place(up), &mut strain);
                    }
                    strain[0]
                };
                let series = passage(of, side)
                    .map(|(turn_rad, shift, patches)| (turn_rad, strain(shift, patches)));
                all.push(GaugeStrain {
                    member,
                    name: gauge.name.clone(),
                    tooth: gauge.tooth,
                    torque_nm: of.torque_nm,
                    series: series.collect(),
                });
            }
        }
    }
    Ok(all)
}

/// Turn of the pinion, pitches that it has turned on counter-clockwise, patches: all positions of the pitches around the one that was loaded, in the order in which the
/// pair goes through them.
fn passage(of: &LoadedContact, side: Flank) -> impl Iterator<Item = (f64, i32, &[LoadedPatch])> {
    // Positions follow one another in the driven sense.
    let sense = if side.mirror() > 0.0 { -1 } else { 1 };
    let step_rad = match of.positions.as_slice() {
        [first, second, ..] => (second.pinion_turn_rad - first.pinion_turn_rad).abs(),
        _ => 0.0,
    };
    let pitch_rad = step_rad * of.positions.len() as f64;
    (-PITCHES..=PITCHES).flat_map(move |pitches| {
        let shift = sense * pitches;
        of.positions.iter().map(move |position| {
            let turn_rad = position.pinion_turn_rad + f64::from(shift) * pitch_rad;
            (turn_rad, shift, position.patches.as_slice())
        })
    })
}

/// Lines of the first screen; none without gauges.
pub fn lines(found: &[GaugeStrain]) -> Vec<String> {
    if found.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![format!(
        "{:<24} {:>10}  {:>20}  {:>20}",
        "root strain, ustrain", "torque N m", "method 1", "method 2"
    )];
    for of in found {
        let name = format!("{} {}", MEMBERS[of.member], of.name);
        let [one, two] = METHODS.map(|method| of.shown(method));
        lines.push(format!(
            "{name:<24} {:>10}  {one:>20}  {two:>20}",
            of.torque_nm
        ));
    }
    lines
}

/// The page's table; none without gauges.
pub fn table(found: &[GaugeStrain]) -> Option<Table> {
    let mut table = Table::new("Root strain over the passage of the gauged tooth, µε")
        .column("gauge", Align::Left)
        .column("torque N m", Align::Right)
        .column("method 1", Align::Right)
        .column("method 2", Align::Right);
    for of in found {
        let [one, two] = METHODS.map(|method| of.shown(method));
        let name = format!("{} {}", MEMBERS[of.member], of.name);
        table.push_row([name, format!("{}", of.torque_nm), one, two]);
    }
    (!found.is_empty()).then_some(table)
}

/// For other programs.
pub fn figures(found: &[GaugeStrain]) -> Value {
    let each = found.iter().map(|of| {
        let series = of.series.iter();
        json!({
            "member": MEMBERS[of.member],
            "gauge": of.name,
            "tooth": of.tooth,
            "torque_Nm": of.torque_nm,
            "range_method_1_ustrain": of.range(METHODS[0]),
            "range_method_2_ustrain": of.range(METHODS[1]),
            "pinion_deg": series.clone().map(|(turn, _)| turn.to_degrees()).collect::<Vec<_>>(),
            "method_1_ustrain": series.clone().map(|(_, s)| 1e6 * s.method_1).collect::<Vec<_>>(),
            "method_2_ustrain": series.map(|(_, s)| 1e6 * s.method_2).collect::<Vec<_>>(),
        })
    });
    each.collect()
}

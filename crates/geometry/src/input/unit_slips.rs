//! Numbers that are allowed but look like those of another unit: told as warnings, never corrected.

use super::{InputDocument, InputError};

/// Lengths of microgeometry and damage.
const MICRO: &str = "the key is in micrometres, 0.012 mm are 12 um";
const STIFFNESS: &str = "the key is in N/mm, 1e9 N/m are 1e6 N/mm";
const MILLIMETRES: &str = "the key is in millimetres";
const MEGAPASCAL: &str = "the key is in MPa, 1e9 Pa are 1000 MPa";
const NEWTON: &str = "the key is in newtons, 14 kN are 14000 N";
const YOUNG: &str = "steel has 206 GPa, which is 206000 MPa";
const DENSITY: &str = "steel has 7850 kg/m3, which is 7.85e-9 t/mm3 or 7.85 g/cm3";
const HELIX: &str = "the key is in degrees, 0.35 rad are 20 deg";
const C_GAMMA: &str = "c_gamma of steel gears is about 20 N/(mm um), which is 2e10 N/m2";
const WEIGHT: &str = "weight on earth is 9.81 m/s2, which is 9810 mm/s2";
const DAMPING: &str = "damping over stiffness, about 1e-5 s";
const CONTACT: &str = "the key is in degrees, 0.26 rad are 15 deg";

/// Keys, the magnitudes that are usual, from and to, and what to think of others.
const USUAL: [(&str, f64, f64, &str); 40] = [
    ("young_GPa", 0.1, 1500.0, YOUNG),
    ("density_kg_per_m3", 100.0, 25_000.0, DENSITY),
    ("tip_relief_um", 0.2, 500.0, MICRO),
    ("profile_crowning_um", 0.2, 500.0, MICRO),
    ("lead_crowning_um", 0.2, 500.0, MICRO),
    ("flank_angle_um", 0.2, 500.0, MICRO),
    ("root_relief_um", 0.2, 500.0, MICRO),
    ("end_relief_um", 0.2, 500.0, MICRO),
    ("profile_angle_um", 0.2, 500.0, MICRO),
    ("twist_um", 0.2, 500.0, MICRO),
    ("offset_um", 0.1, 2000.0, MICRO),
    ("depth_um", 0.1, 5000.0, MICRO),
    ("removed_um", 0.05, 5000.0, MICRO),
    ("full_damping_depth_um", 0.02, 1000.0, MICRO),
    ("full_depth_um", 0.02, 1000.0, MICRO),
    ("module_mm", 0.1, 60.0, MILLIMETRES),
    ("face_width_mm", 0.5, 2000.0, MILLIMETRES),
    ("centre_distance_mm", 2.0, 20_000.0, MILLIMETRES),
    ("helix_angle_deg", 0.8, 45.0, HELIX),
    ("radial_stiffness_N_per_mm", 10.0, 1e8, STIFFNESS),
    ("axial_stiffness_N_per_mm", 10.0, 1e8, STIFFNESS),
    ("stiffness_N_per_mm_um", 0.5, 100.0, C_GAMMA),
    ("tensile_strength_MPa", 10.0, 10_000.0, MEGAPASCAL),
    ("stress_amplitude_MPa", 1.0, 10_000.0, MEGAPASCAL),
    ("gravity_m_per_s2", 0.1, 1000.0, WEIGHT),
    ("outer_diameters_mm", 0.5, 20_000.0, MILLIMETRES),
    ("stations_mm", 0.5, 100_000.0, MILLIMETRES),
    ("damping_s", 1e-9, 0.1, DAMPING),
    ("bore_diameter_mm", 0.1, 20_000.0, MILLIMETRES),
    ("dynamic_N", 100.0, 1e8, NEWTON),
    ("static_N", 20.0, 1e9, NEWTON),
    ("fatigue_N", 1.0, 1e8, NEWTON),
    ("ball_diameter_mm", 0.25, 500.0, MILLIMETRES),
    ("roller_diameter_mm", 0.5, 500.0, MILLIMETRES),
    ("roller_length_mm", 0.5, 1000.0, MILLIMETRES),
    ("pitch_diameter_mm", 1.0, 20_000.0, MILLIMETRES),
    ("radial_clearance_um", 0.1, 2000.0, MICRO),
    ("preload_um", 0.05, 2000.0, MICRO),
    ("scale_um", 0.05, 1000.0, MICRO),
    ("contact_angle_deg", 0.8, 90.0, CONTACT),
];

/// Young's modulus of bodies that are meant as rigid, a hundred times that of steel \[GPa\]: no slip.
const RIGID_GPA: f64 = 20_000.0;

impl InputDocument {
    /// Numbers of the file that look like those of another unit, each told as a complaint at its key. Zero is never
    /// one; a list is judged by its largest magnitude. None for a text that is no TOML.
    #[must_use]
    pub fn unit_slips(&self) -> Vec<InputError> {
        let mut found = Vec::new();
        if let Ok(table) = self.table() {
            for (key, value) in &table {
                self.slips_below(value, (key, key), &mut found);
            }
        }
        found
    }

    /// Slips of a value with its dotted path and its last key.
    fn slips_below(
        &self,
        value: &toml::Value,
        (path, key): (&str, &str),
        found: &mut Vec<InputError>,
    ) {
        if let Some((_, low, high, hint)) = USUAL.iter().find(|usual| usual.0 == key)
            && let Some(size) = largest(value)
        {
            let is_rigid = key == "young_GPa" && size == RIGID_GPA;
            if size != 0.0 && !is_rigid && !(low..=high).contains(&&size) {
                found.push(self.error(
                    path,
                    format!("{size} is unusual, {low} to {high} is usual; a slip of units? {hint}"),
                ));
            }
            return;
        }
        match value {
            toml::Value::Table(table) => {
                for (key, value) in table {
                    self.slips_below(value, (&format!("{path}.{key}"), key), found);
                }
            }
            toml::Value::Array(items) => {
                for (i, item) in items.iter().enumerate() {
                    self.slips_below(item, (&format!("{path}.{i}"), ""), found);
                }
            }
            _ => {}
        }
    }
}

/// Magnitude of a number, or the largest of a list of numbers.
fn largest(value: &toml::Value) -> Option<f64> {
    match value {
        toml::Value::Float(number) => Some(number.abs()),
        toml::Value::Integer(number) => Some((*number as f64).abs()),
        toml::Value::Array(items) => items
            .iter()
            .map(largest)
            .try_fold(0.0, |most: f64, size| Some(most.max(size?))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slips(text: &str) -> Vec<String> {
        let document = InputDocument::new("g.toml", text);
        document
            .unit_slips()
            .iter()
            .map(ToString::to_string)
            .collect()
    }

    #[test]
    fn numbers_of_another_unit_are_named() {
        let text = "[material]\nyoung_GPa = 206000\ndensity_kg_per_m3 = 7.8e-9\n[microgeometry]\ntip_relief_um = 0.012\n";
        assert_eq!(
            slips(text),
            [
                "g.toml:3: material.density_kg_per_m3: 0.0000000078 is unusual, 100 to 25000 is usual; a slip of units? steel has 7850 kg/m3, which is 7.85e-9 t/mm3 or 7.85 g/cm3",
                "g.toml:2: material.young_GPa: 206000 is unusual, 0.1 to 1500 is usual; a slip of units? steel has 206 GPa, which is 206000 MPa",
                "g.toml:5: microgeometry.tip_relief_um: 0.012 is unusual, 0.2 to 500 is usual; a slip of units? the key is in micrometres, 0.012 mm are 12 um",
            ]
        );
        let list = "[[gear_mesh]]\nerrors_1 = [{ kind = 'pitch', removed_um = [0.001, -0.004] }]";
        assert!(
            slips(list)[0].starts_with("g.toml:2: gear_mesh.0.errors_1.0.removed_um: 0.004 is")
        );
    }

    #[test]
    fn usual_numbers_and_zeros_are_not() {
        let text = "[material]\nyoung_GPa = 206.0\n[microgeometry]\ntip_relief_um = 0\nlead_crowning_um = -4\n[[e]]\nremoved_um = [0.0, 0.01, 3.0]";
        assert!(slips(text).is_empty());
    }
}

//! Commented files to start from: those of `gearmesh init`, and of what the studio begins.

use crate::schema::TextKind;

/// A file to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Template {
    /// Its name.
    pub name: &'static str,
    /// What kind of file it is; none of parts of files.
    pub kind: Option<TextKind>,
    /// Its text.
    pub text: &'static str,
}

macro_rules! template {
    ($($constant:ident $kind:expr, $name:literal $file:literal;)*) => {
        $(
            #[doc = concat!("`", $file, "`.")]
            pub const $constant: Template = Template {
                name: $name,
                kind: $kind,
                text: include_str!(concat!("../templates/", $file)),
            };
        )*
    };
}

template! {
    PINION Some(TextKind::Gear), "pinion.toml" "pinion.toml";
    WHEEL Some(TextKind::Gear), "wheel.toml" "wheel.toml";
    PAIR Some(TextKind::Scene), "pair.toml" "pair.toml";
    HELICAL_PINION Some(TextKind::Gear), "pinion.toml" "helical_pinion.toml";
    HELICAL_WHEEL Some(TextKind::Gear), "wheel.toml" "helical_wheel.toml";
    HELICAL_PAIR Some(TextKind::Scene), "pair.toml" "helical_pair.toml";
    DRIVE Some(TextKind::Scene), "drive.toml" "drive.toml";
    GEARBOX Some(TextKind::Scene), "gearbox.toml" "gearbox.toml";
    PLANETARY_SUN Some(TextKind::Gear), "planetary_sun.toml" "planetary_sun.toml";
    PLANETARY_PLANET Some(TextKind::Gear), "planetary_planet.toml" "planetary_planet.toml";
    PLANETARY_RING Some(TextKind::Gear), "planetary_ring.toml" "planetary_ring.toml";
    PLANETARY Some(TextKind::Scene), "planetary.toml" "planetary.toml";
    BEARING Some(TextKind::Bearing), "bearing.toml" "bearing.toml";
    OPERATION None, "operation.toml" "operation.toml";
    BEVEL_PAIR Some(TextKind::Bevel), "bevel_pair.toml" "bevel_pair.toml";
    BEVEL_PINION Some(TextKind::BevelGear), "bevel_pinion.toml" "bevel_pinion.toml";
    BEVEL_GEAR Some(TextKind::BevelGear), "bevel_gear.toml" "bevel_gear.toml";
    BEVEL_DRIVE Some(TextKind::Scene), "bevel_drive.toml" "bevel_drive.toml";
}

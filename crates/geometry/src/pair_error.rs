//! Why two gears do not run together, with the numbers that make it impossible.

/// Why two gears do not run together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PairError {
    /// Different base pitches.
    #[error(
        "the transverse base pitches differ: {base_pitch_1_mm:.5} and {base_pitch_2_mm:.5} mm; module, pressure angle and helix angle of both gears must agree"
    )]
    BasePitch {
        /// Base pitch of gear 1.
        base_pitch_1_mm: f64,
        /// Base pitch of gear 2.
        base_pitch_2_mm: f64,
    },
    /// The helices do not fit on parallel axes.
    #[error(
        "the helices do not fit: base helix angles {helix_1_deg:.5} deg ({hand_1}) and {helix_2_deg:.5} deg ({hand_2}); on parallel axes external gears need equal angles of opposite hand, a ring and the gear inside equal angles of the same hand"
    )]
    Helix {
        /// Base helix angle of gear 1 without its sign.
        helix_1_deg: f64,
        /// Hand of gear 1.
        hand_1: &'static str,
        /// Base helix angle of gear 2 without its sign.
        helix_2_deg: f64,
        /// Hand of gear 2.
        hand_2: &'static str,
    },
    /// Two rings.
    #[error("both gears have internal teeth; one of them must have external teeth")]
    TwoRings,
    /// The ring is not larger than the gear inside.
    #[error(
        "the ring has {ring_teeth} teeth and the gear inside {teeth}; at most {allowed} fit inside"
    )]
    RingTooSmall {
        /// Teeth of the ring.
        ring_teeth: usize,
        /// Teeth of the gear inside.
        teeth: usize,
        /// Most teeth inside.
        allowed: usize,
    },
    /// The base circle of the ring is reached inside the path of contact.
    #[error(
        "the tip of the ring reaches below the base circle of gear {gear} (involute interference): its tip diameter must be {least_mm:.4} mm or more"
    )]
    InvoluteInterference {
        /// The gear inside.
        gear: usize,
        /// Smallest tip diameter of the ring.
        least_mm: f64,
    },
    /// Tips collide away from the line of action.
    #[error(
        "the tips of both gears collide beside the line of action, {depth_um:.2} um deep (trochoidal interference): give the ring a tip diameter of {clear_tip_diameter_mm:.4} mm or more, or gear {gear} fewer teeth or a smaller tip diameter"
    )]
    TipsCollide {
        /// The gear inside.
        gear: usize,
        /// Depth along the normal of the ring's flank.
        depth_um: f64,
        /// Tip diameter from which on the ring is clear.
        clear_tip_diameter_mm: f64,
    },
    /// The base circles overlap.
    #[error(
        "a centre distance of {centre_distance_mm:.4} mm is below the sum of the base radii (with a ring: their difference), {smallest_mm:.4} mm: no line of action"
    )]
    CentreDistance {
        /// Centre distance given.
        centre_distance_mm: f64,
        /// Smallest possible.
        smallest_mm: f64,
    },
    /// The teeth are too thick for the centre distance.
    #[error(
        "the teeth do not fit: backlash {backlash_mm:.4} mm at the working pitch circle; raise the centre distance or lower the profile shifts"
    )]
    NoBacklash {
        /// Negative backlash.
        backlash_mm: f64,
    },
    /// A tip reaches into the other gear's root circle.
    #[error(
        "the tip of gear {gear} reaches into the root of its mate: clearance {clearance_mm:.4} mm"
    )]
    TipClearance {
        /// Gear whose tip is too long.
        gear: usize,
        /// Negative clearance.
        clearance_mm: f64,
    },
    /// A tip would run on the other gear's fillet.
    #[error(
        "the tip of gear {gear} would touch the fillet of its mate: contact down to radius {needed_mm:.4} mm, but the involute starts at {form_mm:.4} mm"
    )]
    FilletInterference {
        /// Gear whose tip is too long.
        gear: usize,
        /// Radius on the mate that the tip would reach.
        needed_mm: f64,
        /// Where the mate's involute starts.
        form_mm: f64,
    },
    /// A tip edge cuts into the other gear's fillet on its way through the tooth space.
    #[error(
        "the tip of gear {gear} cuts {depth_um:.2} um deep into the root fillet of its mate; shorten the tip or chamfer it, \
         or raise the clearance or the centre distance"
    )]
    TipInFillet {
        /// Gear whose tip is too long.
        gear: usize,
        /// Depth along the normal of the fillet.
        depth_um: f64,
    },
    /// Contact is lost between two pairs.
    #[error(
        "the transverse contact ratio is {contact_ratio:.4}: below 1 the pair loses contact between teeth (also helical gears are taken from 1 on only)"
    )]
    ContactRatio {
        /// Transverse contact ratio.
        contact_ratio: f64,
    },
}

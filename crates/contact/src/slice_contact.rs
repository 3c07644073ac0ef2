//! The slices of two reduced gears that face each other: compliance, local laws and the forces at given separations.
//!
//! This is what the static contact and the gear mesh of a multibody system share: it is told which lines and slices face each other and
//! how far apart they stand, and does not ask where that comes from.

use crate::contact_error::ContactError;
use crate::contact_lines::{ContactLine, ContactLines};
use crate::contact_slices::ContactSlice;
use crate::contact_zone::SliceLayout;
use crate::local_contact::{LawRate, LocalContact};
use crate::nlcp::{
    ContactBody, EdgeContact, Info, LineContact, LocalLaw, LocalLawError, NlcpError, Params,
    Problem, Workspace, solve_load, solve_position,
};
use crate::placed_slice::PlacedSlice;
use crate::roll_shares::RollPlace;
use crate::runout::Placement;
use crate::slice_compliance::{LocalDepth, SliceCompliance};
use crate::station_blocks::LineBlock;
use gearmesh_geometry::FlankSide;
use gearmesh_model::{Flank, ReducedGear};

mod energy_rates;

/// What is given besides the separations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Given {
    /// Load Σ b F \[N·m\]; the approach follows.
    Load(f64),
    /// Approach \[m\]; the load follows.
    Approach(f64),
}

/// Separations of the slices, how fast they close, and the levers of their forces; see [`crate::nlcp`].
#[derive(Debug, Clone, Copy)]
pub struct Separations<'a> {
    /// e \[m\], open positive.
    pub separation_m: &'a [f64],
    /// w.
    pub closing: &'a [f64],
    /// b \[m\].
    pub lever_m: &'a [f64],
}

/// Two reduced gears in contact, with all memory that a solve needs.
#[derive(Debug, Clone)]
pub struct SliceContact {
    lines: ContactLines,
    layout: SliceLayout,
    centres_m: Vec<f64>,
    compliance_1: SliceCompliance,
    compliance_2: SliceCompliance,
    local_contact: LocalContact,
    params: Params,
    /// Where each line stands on both gears.
    places: Vec<[RollPlace; 2]>,
    /// Compliance of each gear between a line and another one after it, with its changes; only those of pairs of different lines and
    /// of lines with themselves in use.
    line_blocks: Vec<LineBlock>,
    /// Depths of the local logarithm for each law that was made: the slices of a spur line share one.
    depths: Vec<[LocalDepth; 2]>,
    /// How each of these laws changes with the roll angle on both gears.
    law_rates: Vec<[LawRate; 2]>,
    /// Of helical teeth: where each slice stands on both gears, and the share of its width that touches.
    placed: Vec<[PlacedSlice; 2]>,
    shares: Vec<f64>,
    /// Without a local law: compliance of each slice before it was divided by its share \[m/N\].
    own_compliance: Vec<f64>,
    c: Vec<f64>,
    /// Hertz contact of each touching slice, and the edge where it is one.
    hertz: Vec<(LineContact, Option<EdgeContact>)>,
    local: Vec<LocalLaw>,
    work: Workspace,
}

impl SliceContact {
    /// Prepares the contact of two gears on the flanks that the pair names, on slices over the overlap of the models' faces at the axial
    /// displacement of the lines' zone.
    ///
    /// # Errors
    /// [`ContactError`] when the models do not fit the pair or each other.
    pub fn new(
        mut lines: ContactLines,
        gear_1: &ReducedGear,
        gear_2: &ReducedGear,
        local_contact: LocalContact,
    ) -> Result<Self, ContactError> {
        if lines.pair.is_helical() && lines.extension.is_some() {
            return Err(ContactError::HelicalExtension);
        }
        let flank = match lines.pair.flank {
            FlankSide::Right => Flank::Right,
            FlankSide::Left => Flank::Left,
        };
        for (gear, model, needed) in [
            (1, gear_1, lines.pair.gear_1.teeth),
            (2, gear_2, lines.pair.gear_2.teeth),
        ] {
            if model.teeth != needed {
                return Err(ContactError::Teeth {
                    gear,
                    found: model.teeth,
                    needed,
                });
            }
        }
        let layout = SliceLayout::of_models([gear_1, gear_2], lines.zone.displacement_m);
        layout.check()?;
        lines.zone = layout.reference;
        let condense = |gear: usize, model: &ReducedGear| {
            let spread = layout.spread(gear, model);
            SliceCompliance::on_slices(model, flank, local_contact, &spread)
        };
        let compliance_1 = condense(1, gear_1)?;
        let compliance_2 = condense(2, gear_2)?;
        let slices = layout.slices;
        // Tip edges add up to half a pitch at either end, and gears may stand closer together than the pair.
        let most_lines = lines.most_pairs() + 2;
        let capacity = most_lines * slices;
        Ok(Self {
            places: Vec::with_capacity(most_lines),
            line_blocks: vec![LineBlock::new(slices); 2 * most_lines * most_lines],
            depths: Vec::with_capacity(capacity),
            law_rates: Vec::with_capacity(capacity),
            shares: Vec::with_capacity(capacity),
            own_compliance: Vec::with_capacity(capacity),
            lines,
            layout,
            centres_m: layout.centres_m(),
            compliance_1,
            compliance_2,
            local_contact,
            params: Params::default(),
            placed: Vec::with_capacity(capacity),
            c: vec![0.0; capacity * capacity],
            hertz: Vec::with_capacity(capacity),
            local: Vec::with_capacity(capacity),
            work: Workspace::new(capacity),
        })
    }

    /// Rigid kinematics of the pair.
    pub fn lines(&self) -> &ContactLines {
        &self.lines
    }

    /// Puts the gears into their places.
    pub fn place(&mut self, placement: &Placement) {
        self.lines.place(placement);
    }

    /// Largest number of slices at once.
    pub fn capacity(&self) -> usize {
        self.work.capacity()
    }

    /// Slices per contact line.
    pub fn slices(&self) -> usize {
        self.compliance_1.slices()
    }

    /// Width of a slice \[m\].
    pub fn slice_width_m(&self) -> f64 {
        self.layout.width_m()
    }

    /// Middles of the slices from halfway between the gears' mid-faces \[m\].
    pub fn slice_centres_m(&self) -> &[f64] {
        &self.centres_m
    }

    /// Where the slices lie.
    pub fn layout(&self) -> &SliceLayout {
        &self.layout
    }

    /// Forgets the last solution: the next solve starts cold.
    pub fn reset(&mut self) {
        self.work.reset();
    }

    /// Lets the next solve at a given approach start from these forces \[N\], one for each slice; see [`Workspace::start_from`].
    pub fn start_from(&mut self, forces_n: &[f64]) {
        self.work.start_from(forces_n);
    }

    /// Takes R Rᵀ from the compliance of the slices that were prepared: what `columns` quantities of R, `[slice][column]` \[√(m/N)\],
    /// carry elsewhere, as the vibration modes of a gear body do.
    pub fn subtract_from_compliance(&mut self, rows: &[f64], columns: usize) {
        if columns == 0 {
            return;
        }
        let n = rows.len() / columns;
        for (i, a) in rows.chunks_exact(columns).enumerate() {
            for (j, b) in rows.chunks_exact(columns).enumerate().take(i + 1) {
                let shared = dot(a, b);
                self.c[i * n + j] -= shared;
                if i != j {
                    self.c[j * n + i] -= shared;
                }
            }
        }
    }

    /// Hertz contact of the slice with this number, and its edge.
    ///
    /// # Panics
    /// If there is no such slice.
    pub fn hertz(&self, slice: usize) -> (LineContact, Option<EdgeContact>) {
        self.hertz[slice]
    }

    /// Normal forces \[N\] of the last solve, in the order of the slices.
    pub fn forces_n(&self) -> &[f64] {
        self.work.forces()
    }

    /// Change of the forces with the separations, see [`Workspace::apply_tangent`].
    pub fn apply_tangent(&mut self, separation_change: &[f64], force_change: &mut [f64]) {
        self.work.apply_tangent(separation_change, force_change);
    }

    /// Makes compliance and local laws of the slices that face each other. `floor_n`: force below which the logarithm of the local
    /// law is continued by its tangent.
    ///
    /// # Errors
    /// [`LocalLawError`] and the number of the slice that has no local law.
    pub fn prepare(
        &mut self,
        active: &[ContactLine],
        touching: &[ContactSlice],
        floor_n: f64,
    ) -> Result<(), (LocalLawError, usize)> {
        if self.lines.pair.is_helical() {
            self.fill_compliance_by_slices(touching);
        } else {
            self.find_places(active);
            self.fill_compliance_by_lines(active, false);
        }
        self.take_shares(touching);
        self.fill_laws(touching, floor_n)
    }

    fn find_places(&mut self, active: &[ContactLine]) {
        let (first, second) = (&self.compliance_1, &self.compliance_2);
        let both =
            |line: &ContactLine| [first.place(line.roll_1_rad), second.place(line.roll_2_rad)];
        self.places.clear();
        self.places.extend(active.iter().map(both));
    }

    fn fill_laws(
        &mut self,
        touching: &[ContactSlice],
        floor_n: f64,
    ) -> Result<(), (LocalLawError, usize)> {
        self.hertz.clear();
        self.local.clear();
        self.depths.clear();
        let mut last: Option<(usize, (LineContact, Option<EdgeContact>), LocalLaw)> = None;
        for (number, slice) in touching.iter().enumerate() {
            let (hertz, law) = match last {
                // The slices of a spur line are all alike.
                Some((line, hertz, law)) if line == slice.line && !self.lines.pair.is_helical() => {
                    (hertz, law)
                }
                _ => {
                    let (contact, edge, depths) = self.line_contact(slice);
                    let law = (self.local_contact.law(&contact, floor_n))
                        .map_err(|cause| (cause, number))?
                        .with_edge(edge);
                    self.depths.push(depths);
                    ((contact, edge), law)
                }
            };
            last = Some((slice.line, hertz, law));
            self.hertz.push(hertz);
            self.local.push(law);
        }
        Ok(())
    }

    /// Solves for the forces of the slices that were prepared; returns the approach at which the first would touch, and the solver's
    /// figures. No allocation.
    ///
    /// # Errors
    /// [`NlcpError`].
    pub fn solve(&mut self, at: Separations<'_>, given: Given) -> Result<(f64, Info), NlcpError> {
        let n = at.separation_m.len();
        let problem = Problem::new(
            &self.c[..n * n],
            &self.local,
            at.separation_m,
            at.closing,
            at.lever_m,
        )?;
        let info = match given {
            Given::Load(load) => solve_load(&problem, load, &self.params, &mut self.work),
            Given::Approach(approach) => {
                solve_position(&problem, approach, &self.params, &mut self.work)
            }
        }?;
        Ok((problem.first_contact(), info))
    }

    /// Elastic energy \[J\] of the last solve: ½ FᵀCF and that of the local laws.
    pub fn stored_energy_j(&self) -> f64 {
        let forces = self.work.forces();
        let n = forces.len();
        let quadratic: f64 = (forces.iter().zip(self.c.chunks_exact(n.max(1))))
            .map(|(force, row)| force * dot(row, forces))
            .sum();
        let local: f64 = (self.local.iter().zip(forces))
            .map(|(law, force)| law.stored_energy(*force))
            .sum();
        0.5 * quadratic + local
    }

    /// Hertz contact of a slice, its edge, and the depths of both bodies.
    fn line_contact(
        &self,
        slice: &ContactSlice,
    ) -> (LineContact, Option<EdgeContact>, [LocalDepth; 2]) {
        let line = &slice.section;
        let helix_cos = self.lines.pair.base_helix_angle_rad().cos();
        let gears = [
            (&self.compliance_1, line.roll_1_rad),
            (&self.compliance_2, line.roll_2_rad),
        ];
        let depths = gears.map(|(compliance, roll)| {
            compliance.local_depth(roll, &compliance.place(roll), slice.share)
        });
        let body = |gear: usize| {
            let (youngs_modulus_pa, poisson_ratio) = gears[gear].0.material();
            ContactBody {
                youngs_modulus_pa,
                poisson_ratio,
                depth_m: depths[gear].depth_m,
            }
        };
        let contact = LineContact {
            width_m: slice.share * self.slice_width_m() / helix_cos,
            relative_radius_m: self.lines.relative_radius_m(line),
            bodies: [body(0), body(1)],
        };
        let edge = (self.lines.edge(line))
            .and_then(|(tilt_rad, radius_m)| EdgeContact::new(&contact, tilt_rad, radius_m));
        (contact, edge, depths)
    }

    /// C of slices that share the place of their line, block by block.
    fn fill_compliance_by_lines(&mut self, active: &[ContactLine], with_rates: bool) {
        let slices = self.slices();
        let n = active.len() * slices;
        let c = &mut self.c[..n * n];
        c.fill(0.0);
        for (i, a) in active.iter().enumerate() {
            for (j, b) in active.iter().enumerate().skip(i) {
                for (gear, compliance, teeth) in [
                    (0, &self.compliance_1, [a.tooth_1, b.tooth_1]),
                    (1, &self.compliance_2, [a.tooth_2, b.tooth_2]),
                ] {
                    let block = &mut self.line_blocks[block_number(active.len(), gear, i, j)];
                    let place_a = (teeth[0], &self.places[i][gear]);
                    let place_b = (teeth[1], &self.places[j][gear]);
                    if with_rates {
                        compliance.line_block_with_rates(place_a, place_b, block);
                    } else {
                        compliance.line_block(place_a, place_b, &mut block.value);
                    }
                    let along_normals = a.tilt_rad(gear).cos() * b.tilt_rad(gear).cos();
                    for (row, values) in block.value.chunks_exact(slices).enumerate() {
                        let first = (i * slices + row) * n + j * slices;
                        for (place, value) in c[first..first + slices].iter_mut().zip(values) {
                            *place += along_normals * value;
                        }
                    }
                }
            }
        }
        // The blocks of two lines are each other's transpose; those on the diagonal are symmetric to rounding.
        for row in 0..n {
            for column in 0..row {
                let same_line = row / slices == column / slices;
                let above = c[column * n + row];
                let mean = 0.5 * (c[row * n + column] + above);
                let value = if same_line { mean } else { above };
                c[row * n + column] = value;
                c[column * n + row] = value;
            }
        }
    }

    /// C of slices that each have their own place, entry by entry.
    fn fill_compliance_by_slices(&mut self, touching: &[ContactSlice]) {
        let n = touching.len();
        let gears = [&self.compliance_1, &self.compliance_2];
        self.placed.clear();
        self.placed.extend(touching.iter().map(|s| {
            let line = &s.section;
            let placed = |gear: usize, tooth: usize, roll: f64| PlacedSlice {
                tooth,
                slice: s.slice,
                place: gears[gear].place(roll),
            };
            [
                placed(0, line.tooth_1, line.roll_1_rad),
                placed(1, line.tooth_2, line.roll_2_rad),
            ]
        }));
        let c = &mut self.c[..n * n];
        for (i, a) in self.placed.iter().enumerate() {
            for (j, b) in self.placed.iter().enumerate() {
                c[i * n + j] =
                    gears[0].between_slices(&a[0], &b[0]) + gears[1].between_slices(&a[1], &b[1]);
            }
        }
        symmetrise(c, n);
    }

    /// Shares of the slices' widths that touch.
    fn take_shares(&mut self, touching: &[ContactSlice]) {
        self.shares.clear();
        self.shares.extend(touching.iter().map(|slice| slice.share));
        self.own_compliance.clear();
        if self.local_contact != LocalContact::None {
            return;
        }
        // No local term takes the force of a slice that is partly on the path to zero with its share: the slice's own
        // compliance grows instead.
        let n = touching.len();
        for (i, share) in self.shares.iter().enumerate() {
            self.own_compliance.push(self.c[i * n + i]);
            self.c[i * n + i] /= share;
        }
    }
}

/// Number of the block of lines a ≤ b on a gear among those of so many lines.
fn block_number(lines: usize, gear: usize, a: usize, b: usize) -> usize {
    (gear * lines + a) * lines + b
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The blocks between two teeth are stored for each of them as load and as response; they agree to the round-off of
/// the reduction, and the solver wants them equal.
fn symmetrise(c: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..i {
            let mean = 0.5 * (c[i * n + j] + c[j * n + i]);
            c[i * n + j] = mean;
            c[j * n + i] = mean;
        }
    }
}

//! An elastica is a boundary value problem. This module defines its pieces and joints, their
//! equations (derived in `elastica/mod.rs`), and Newton's method for them.

use crate::linalg::PivotingBand;
use crate::math::{Vec2, perp};

/// Difference of the normals of one line in two contacts: round-off. Smaller: a line counts as two;
/// larger: two neighbouring edges of one polygon count as one.
const SAME_NORMAL_DIFFERENCE: f64 = 1e-9;

/// Unknowns at a node: x, y, θ, M, F (2), s and the length of its piece in s.
pub(super) const STATES: usize = 8;
/// Index of θ among the unknowns.
pub(super) const ANGLE: usize = 2;
/// Index of M among the unknowns.
pub(super) const MOMENT: usize = 3;
/// Index of s among the unknowns.
pub(super) const ARC: usize = 6;
/// Index of the length of the piece among the unknowns.
pub(super) const LENGTH: usize = 7;

/// Half-bandwidth: rows of a joint are up to 13 away from the columns they belong to.
const HALF_BAND: usize = 16;

/// Maximum number of Newton steps. 5 to 8 are usual; beyond this limit none converged.
const MAX_STEPS: usize = 40;

/// Greatest turn of a node in one step, rad.
const LONGEST_TURN: f64 = 0.4;

/// Fraction of its length that a piece may lose in one step, so that it does not turn over.
const PIECE_SHORTENING_LIMIT: f64 = 0.6;

/// Number of successive steps in which a stretch of contact tends to a negative length before it
/// becomes a point. Smaller: stretches whose first guess is too long become points; larger: all
/// other pieces wait for it.
const STEPS_BEFORE_POINT_CONTACT: usize = 3;

/// Work spent on a cable from one guess, in Newton steps times nodes. Smaller: cables with ten
/// contacts are left to a chain of bars; larger: seconds are spent on guesses that fail. Chosen so
/// that a guess costs some tenths of a second; not tuned further.
pub(super) const MOST_WORK: usize = 25_000;

/// Newton's method has converged when no unknown moves by more than this fraction of its size.
const STEP_TOLERANCE: f64 = 1e-10;

/// Step of central differences, as a fraction of the unknown's size: their error is its square.
const DIFFERENCE_STEP: f64 = 1e-6;

/// A surface on which the cable can lie, at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ContactSurface {
    /// Index of the obstacle in the scene, or of the pulley among the supports.
    pub(super) owner: Owner,
    /// Centre of a round, or a point of the line, m, where the centre line of the cable runs.
    pub(super) at: Vec2,
    /// Radius of the cable's centre line, m; None: a line.
    pub(super) radius: Option<f64>,
    /// Outward normal of a line.
    pub(super) normal: Vec2,
    /// +1 if the cable passes it anticlockwise, −1 clockwise.
    pub(super) sense: f64,
    /// Mobilised friction: force along growing arc length over normal force.
    pub(super) mobilised: f64,
    /// True if that is all the friction there is: the contact slips.
    pub(super) slips: bool,
}

/// The owner of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    Obstacle(usize),
    Pulley(usize),
}

/// Appends the residuals of some states.
type ResidualFn<'a> = dyn Fn(&[[f64; STATES]], &mut Vec<f64>) + 'a;

impl ContactSurface {
    /// Gap (m) and outward normal at a place.
    pub(super) fn gap(&self, x: Vec2) -> (f64, Vec2) {
        let d = x - self.at;
        match self.radius {
            None => (d.dot(&self.normal), self.normal),
            Some(radius) => {
                let far = d.norm();
                if far > 0.0 { (far - radius, d / far) } else { (-radius, self.normal) }
            }
        }
    }

    /// Curvature of a cable that lies on it, with its sign, 1/m.
    pub(super) fn curvature(&self) -> f64 {
        self.radius.filter(|r| *r > 0.0).map_or(0.0, |r| self.sense / r)
    }

    /// True if two contacts are with the same line or round.
    pub(super) fn is_same_surface(&self, other: &Self) -> bool {
        self.owner == other.owner
            && self.radius == other.radius
            && if self.radius.is_some() {
                self.at == other.at
            } else {
                (self.normal - other.normal).norm() < SAME_NORMAL_DIFFERENCE
            }
    }

    /// True if it is a sharp corner: a cable slides over it, and no stretch of cable can lie on it.
    pub(super) fn is_point(&self) -> bool {
        self.radius == Some(0.0)
    }
}

/// A piece of cable between two joints.
#[derive(Clone, Debug)]
pub(super) struct ElasticaPiece {
    /// The contact it lies on; None: it is free.
    pub(super) contact: Option<usize>,
    /// Places of its nodes along it, 0 to 1.
    pub(super) grid: Vec<f64>,
    pub(super) nodes: Vec<[f64; STATES]>,
}

/// A point where two pieces meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Joint {
    /// A contact in one point.
    PointContact(usize),
    /// A stretch of contact begins.
    ContactBegin(usize),
    /// A stretch of contact ends.
    ContactEnd(usize),
    /// A support holds the cable at an arc length (m) and a position (m), in a direction (rad)
    /// where it is clamped.
    Held { support: usize, arc: f64, at: Vec2, angle: Option<f64> },
    /// A dead load (N) acts at an arc length (m): that of a support, or a point load.
    Load { support: Option<usize>, arc: f64, force: Vec2 },
}

/// An end of the cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// Held, in a direction (rad) where it is clamped.
    Held(Vec2, Option<f64>),
    /// Under a dead load, N.
    Loaded(Vec2),
}

/// A cable at rest.
#[derive(Clone, Debug)]
pub struct Elastica {
    pub(super) axial_stiffness: f64,
    /// The bending stiffness at present, N·m².
    pub(super) bending: f64,
    pub(super) thermal_stretch: f64,
    pub(super) body: Vec2,
    pub(super) length: f64,
    /// Forces of the scene, N.
    pub(super) scale: f64,
    pub(super) pieces: Vec<ElasticaPiece>,
    pub(super) joints: Vec<Joint>,
    pub(super) ends: [End; 2],
    pub(super) contacts: Vec<ContactSurface>,
    /// Number of Newton steps so far.
    pub steps: usize,
    /// Sum over these steps of the number of nodes.
    pub(super) work: usize,
    pub(super) residual: f64,
    /// The piece whose length Newton's method made negative.
    pub(super) shrinking: Option<usize>,
}

pub(super) fn place(u: &[f64; STATES]) -> Vec2 {
    Vec2::new(u[0], u[1])
}

pub(super) fn tangent(u: &[f64; STATES]) -> Vec2 {
    Vec2::new(u[ANGLE].cos(), u[ANGLE].sin())
}

pub(super) fn force(u: &[f64; STATES]) -> Vec2 {
    Vec2::new(u[4], u[5])
}

pub(super) fn tension(u: &[f64; STATES]) -> f64 {
    force(u).dot(&tangent(u))
}

/// Sine of the angle between the cable and the tangent of the line or round: zero where the cable
/// is tangent.
fn slant(contact: &ContactSurface, u: &[f64; STATES]) -> f64 {
    contact.gap(place(u)).1.dot(&tangent(u))
}

impl Elastica {
    /// Force of a contact along its normal, per unstretched metre, on a piece that lies on it, N/m.
    pub(super) fn pressure(&self, contact: &ContactSurface, u: &[f64; STATES]) -> f64 {
        let t = tangent(u);
        let pull = force(u).dot(&t);
        let turn = self.thermal_stretch * (1.0 + pull / self.axial_stiffness) * contact.curvature();
        contact.sense * (pull * turn + self.body.dot(&perp(t)))
    }

    /// The derivatives of all unknowns along a piece.
    pub(super) fn slope(&self, contact: Option<usize>, u: &[f64; STATES]) -> [f64; STATES] {
        let (t, f) = (tangent(u), force(u));
        let n = perp(t);
        let pull = f.dot(&t);
        let stretch = self.thermal_stretch * (1.0 + pull / self.axial_stiffness);
        let l = u[LENGTH];
        let [turn, moment, df] = match contact.and_then(|k| self.contacts.get(k)) {
            None => [
                Vec2::new(self.thermal_stretch * u[MOMENT] / self.bending, 0.0),
                Vec2::new(-stretch * f.dot(&n), 0.0),
                -self.body,
            ],
            Some(c) => {
                let turn = stretch * c.curvature();
                let along = -self.body.dot(&t) - c.mobilised * self.pressure(c, u);
                let moment = self.bending * c.curvature() * along / self.axial_stiffness;
                [Vec2::new(turn, 0.0), Vec2::new(moment, 0.0), t * along + n * (pull * turn)]
            }
        };
        [l * stretch * t.x, l * stretch * t.y, l * turn.x, l * moment.x, l * df.x, l * df.y, l, 0.0]
    }

    /// Residual of Simpson's rule in an element, with the middle of Hermite's cubic.
    fn element_residual(&self, contact: Option<usize>, h: f64, a: &[f64; STATES], b: &[f64; STATES]) -> [f64; STATES] {
        let (fa, fb) = (self.slope(contact, a), self.slope(contact, b));
        let middle = std::array::from_fn(|i| 0.5 * (a[i] + b[i]) + 0.125 * h * (fa[i] - fb[i]));
        let fm = self.slope(contact, &middle);
        std::array::from_fn(|i| b[i] - a[i] - h / 6.0 * (fa[i] + 4.0 * fm[i] + fb[i]))
    }

    /// Appends the equations at an end of the cable, whose piece lies on `contact` if on any.
    fn end_equations(&self, which: usize, contact: Option<usize>, u: &[f64; STATES], out: &mut Vec<f64>) {
        out.push(u[ARC] - if which == 0 { 0.0 } else { self.length });
        let sign = if which == 0 { -1.0 } else { 1.0 };
        let contact = contact.and_then(|k| self.contacts.get(k));
        if let (0, Some(c)) = (which, contact) {
            self.lying_equations(c, u, out);
        }
        match (self.ends[which], contact) {
            // The contact prescribes the direction and distance of an end that lies on it, so only
            // its place along the contact or its tension is free.
            (End::Held(at, _), Some(_)) => out.push((place(u) - at).dot(&tangent(u))),
            (End::Loaded(load), Some(c)) => {
                out.push(tension(u) - sign * (load.dot(&tangent(u)) + c.mobilised * self.tip_push(which, c, u)));
            }
            (End::Held(at, angle), None) => {
                let off = place(u) - at;
                out.extend([off.x, off.y, angle.map_or(u[MOMENT], |a| u[ANGLE] - a)]);
            }
            (End::Loaded(load), None) => {
                let off = force(u) - load * sign;
                out.extend([off.x, off.y, u[MOMENT]]);
            }
        }
    }

    /// Normal point force (N) of a contact on an end that lies on it, which balances the load of
    /// that end.
    pub(super) fn tip_push(&self, which: usize, c: &ContactSurface, u: &[f64; STATES]) -> f64 {
        match self.ends[which] {
            End::Loaded(load) => c.sense * load.dot(&perp(tangent(u))),
            End::Held(..) => 0.0,
        }
    }

    /// Appends the four conditions under which a piece lies on its contact. If they hold at its
    /// start, they hold all along it.
    fn lying_equations(&self, c: &ContactSurface, u: &[f64; STATES], out: &mut Vec<f64>) {
        let bent = self.bending * c.curvature() * (1.0 + tension(u) / self.axial_stiffness);
        out.extend([c.gap(place(u)).0, slant(c, u), u[MOMENT] - bent, force(u).dot(&perp(tangent(u)))]);
    }

    /// Appends the equations where two pieces meet.
    fn joint_equations(&self, joint: Joint, a: &[f64; STATES], b: &[f64; STATES], out: &mut Vec<f64>) {
        let jump = |c: &ContactSurface| {
            let (t, d) = (tangent(a), force(b) - force(a));
            let normal = perp(t) * -c.sense;
            d.dot(&t) - c.mobilised * d.dot(&normal)
        };
        let (xa, xb) = (place(a), place(b));
        match joint {
            Joint::PointContact(k) | Joint::ContactBegin(k) | Joint::ContactEnd(k) => {
                out.extend((0..=MOMENT).map(|i| b[i] - a[i]));
                out.push(b[ARC] - a[ARC]);
                let Some(c) = self.contacts.get(k) else { return };
                out.push(jump(c));
                match joint {
                    Joint::PointContact(_) if c.is_point() => out.extend([(xa - c.at).x, (xa - c.at).y]),
                    Joint::PointContact(_) => out.extend([c.gap(xa).0, slant(c, a)]),
                    Joint::ContactBegin(_) => self.lying_equations(c, b, out),
                    _ => {}
                }
            }
            Joint::Held { arc: s, at, angle, .. } => {
                out.extend([a[ARC] - s, b[ARC] - s, (xa - at).x, (xa - at).y, (xb - at).x, (xb - at).y]);
                match angle {
                    Some(angle) => out.extend([a[ANGLE] - angle, b[ANGLE] - angle]),
                    None => out.extend([b[ANGLE] - a[ANGLE], b[MOMENT] - a[MOMENT]]),
                }
            }
            Joint::Load { arc: s, force: load, .. } => {
                let d = force(b) - force(a) + load;
                out.extend([a[ARC] - s, b[ARC] - s, d.x, d.y]);
                out.extend((0..=MOMENT).map(|i| b[i] - a[i]));
            }
        }
    }

    /// The scale of each unknown.
    fn sizes(&self) -> [f64; STATES] {
        let moment = self
            .pieces
            .iter()
            .flat_map(|p| &p.nodes)
            .fold(0.0f64, |m, u| if u[MOMENT].abs() > m { u[MOMENT].abs() } else { m });
        let least = self.bending / self.length;
        let moment = if moment > least { moment } else { least };
        let f = self.scale + self.bending / (self.length * self.length);
        [self.length, self.length, 1.0, moment, f, f, self.length, self.length]
    }

    /// Solves all equations with the present set of contacts; returns false if the iteration does
    /// not converge.
    pub(super) fn newton(&mut self) -> bool {
        // Number of successive steps in which a piece in contact would get a negative length.
        let mut vanishing = vec![0; self.pieces.len()];
        self.shrinking = None;
        for _ in 0..MAX_STEPS {
            self.work += self.pieces.iter().map(|p| p.nodes.len()).sum::<usize>();
            if self.work > MOST_WORK {
                return false;
            }
            let sizes = self.sizes();
            let Some(step) = self.newton_step(&sizes) else { return false };
            let (mut part, mut most, mut turn): (f64, f64, f64) = (1.0, 0.0, 0.0);
            for (u, d) in self.pieces.iter().flat_map(|p| &p.nodes).zip(step.chunks_exact(STATES)) {
                for i in 0..STATES {
                    let moved = d[i].abs() / sizes[i];
                    most = if moved <= most { most } else { moved };
                }
                turn = if d[ANGLE].abs() <= turn { turn } else { d[ANGLE].abs() };
                let shrinks = -d[LENGTH] / u[LENGTH].abs();
                if shrinks > PIECE_SHORTENING_LIMIT {
                    part = part.min(PIECE_SHORTENING_LIMIT / shrinks);
                }
            }
            if !most.is_finite() {
                return false;
            }
            let mut at = 0;
            for (k, p) in self.pieces.iter().enumerate() {
                let gone =
                    p.contact.is_some() && k > 0 && k + 1 < vanishing.len() && -step[at + LENGTH] > p.nodes[0][LENGTH];
                vanishing[k] = if gone { vanishing[k] + 1 } else { 0 };
                at += STATES * p.nodes.len();
            }
            self.shrinking = vanishing.iter().position(|w| *w >= STEPS_BEFORE_POINT_CONTACT);
            if self.shrinking.is_some() {
                return false;
            }
            part = if turn * part > LONGEST_TURN { LONGEST_TURN / turn } else { part };
            for (u, d) in self.pieces.iter_mut().flat_map(|p| &mut p.nodes).zip(step.chunks_exact(STATES)) {
                for i in 0..STATES {
                    u[i] += part * d[i];
                }
            }
            self.steps += 1;
            if part == 1.0 && most < STEP_TOLERANCE {
                return true;
            }
        }
        false
    }

    /// One Newton step for all unknowns; None where the equations are singular.
    fn newton_step(&mut self, sizes: &[f64; STATES]) -> Option<Vec<f64>> {
        let count: usize = self.pieces.iter().map(|p| p.nodes.len()).sum();
        let mut band = PivotingBand::<HALF_BAND, { 3 * HALF_BAND + 1 }>::new(STATES * count);
        let mut right: Vec<f64> = Vec::with_capacity(STATES * count);
        let last = self.pieces.len() - 1;
        let (mut first, mut column) = (Vec::new(), 0);
        // Adds the equations of one place, a function of one or two nodes, with their derivatives.
        let mut add = |column: usize, near: &[[f64; STATES]], of: &ResidualFn<'_>| {
            let row = right.len();
            of(near, &mut right);
            let rows = right.len() - row;
            let (mut high, mut low) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
            let mut moved = near.to_vec();
            for j in 0..STATES * near.len() {
                let (node, i) = (j / STATES, j % STATES);
                let by = DIFFERENCE_STEP * if i == LENGTH { near[node][i].abs() } else { sizes[i] };
                high.clear();
                low.clear();
                moved[node][i] = near[node][i] + by;
                of(&moved, &mut high);
                moved[node][i] = near[node][i] - by;
                of(&moved, &mut low);
                moved[node][i] = near[node][i];
                for r in 0..rows {
                    let slope = (high[r] - low[r]) / (2.0 * by);
                    if slope != 0.0 {
                        band.add(row + r, column + j, slope);
                    }
                }
            }
        };
        for (k, piece) in self.pieces.iter().enumerate() {
            if k == 0 {
                add(column, &piece.nodes[..1], &|u, out| self.end_equations(0, piece.contact, &u[0], out));
            }
            for (e, pair) in piece.nodes.windows(2).enumerate() {
                let h = piece.grid[e + 1] - piece.grid[e];
                add(column, pair, &|u, out| out.extend(self.element_residual(piece.contact, h, &u[0], &u[1])));
                column += STATES;
            }
            first.clear();
            first.extend(piece.nodes.last());
            if k == last {
                add(column, &first, &|u, out| self.end_equations(1, piece.contact, &u[0], out));
            } else {
                first.extend(self.pieces[k + 1].nodes.first());
                let joint = self.joints[k];
                add(column, &first, &|u, out| self.joint_equations(joint, &u[0], &u[1], out));
            }
            column += STATES;
        }
        if right.len() != STATES * count {
            return None;
        }
        self.residual = right.iter().fold(0.0, |m: f64, r| if r.abs() <= m { m } else { r.abs() });
        right.iter_mut().for_each(|r| *r = -*r);
        // Rows are scaled because they mix lengths, angles and forces.
        band.scale(&mut right);
        band.solve(&mut right).then_some(right)
    }

    /// Number of Newton steps and the largest residual that is left.
    #[must_use]
    pub fn cost(&self) -> (usize, f64) {
        (self.steps, self.residual)
    }
}

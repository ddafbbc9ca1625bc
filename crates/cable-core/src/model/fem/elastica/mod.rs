//! The resting place of a stiff cable in contact, as a boundary value problem: the elastica between
//! supports and contacts that are a point or a stretch, without a mesh that contact would have to
//! be found on.
//!
//! With t = (cos θ, sin θ), n = perp(t), the force F of what comes after on what comes before (T =
//! F·t), the moment M and the unstretched arc length s, α = 1 + αₜΔT and ε = T/EA, a free piece
//! obeys
//! ```text
//! x' = α(1 + ε) t,     θ' = αM/EI,     M' = −α(1 + ε) F·n,     F' = −b
//! ```
//! One that lies on a round of radius ρ, passed in the sense σ (+1 anticlockwise, outward normal
//! N = −σn), or on a line (1/ρ = 0), has
//! ```text
//! θ' = α(1 + ε)σ/ρ,    M = EI (1 + ε)σ/ρ,    F = T t,    p = σ(Tθ' + b·n) ≥ 0,    T' = −b·t − μp
//! ```
//! with μ the friction that is mobilised, positive where it pulls the cable along growing s. Where
//! a free piece and one that lies meet, and at a contact in one point, a point force P(N + μt)
//! acts; x, θ and M go through. A contact is one point while its cable is less bent than its round,
//! σM/EI ≤ 1/ρ, and a stretch where that would be broken: what belongs to which is found by an
//! active set. Weightless and without friction T + M²/2EI is the same all along: T falls by EI/2ρ²
//! where the cable lies on a round.
//!
//! Each piece is solved by Lobatto collocation of fourth order (U. Ascher, R. Mattheij, R.
//! Russell, *Numerical Solution of Boundary Value Problems for Ordinary Differential Equations*,
//! SIAM 1995), its length s among the unknowns; all equations are local, so the Jacobian is a band.
//! The way there goes from the flexible cable up in EI.

mod active;
mod answer;
mod band;
mod chain_answer;
mod relax;
mod start;

use crate::contact::swept_corners;
use crate::math::{Vec2, perp};
use crate::problem::Problem;
use crate::solution::ErrorEstimates;
use crate::solution::{CableSolution, Cost, Node};
use band::Band;
use relax::{Chain, LetGo};

/// Unknowns at a node: x, y, θ, M, F (2), s and the length of its piece in s.
const STATES: usize = 8;
/// See `STATES`.
const ANGLE: usize = 2;
const MOMENT: usize = 3;
const ARC: usize = 6;
const LENGTH: usize = 7;

/// Half-bandwidth: rows of a joint stand up to 13 from the columns they belong to.
const HALF_BAND: usize = 16;

/// Newton steps. 5 to 8 are usual; more than this finds nothing.
const MAX_STEPS: usize = 40;

/// Longest turn of a node in one step, rad.
const LONGEST_TURN: f64 = 0.4;

/// Part of its length that a piece may lose in one step: it must not turn over.
const PIECE_SHORTENING_LIMIT: f64 = 0.6;

/// Steps in which a stretch of contact wants to be shorter than nothing before it is taken for a
/// point. Fewer: first guesses that are too long are; more: all others wait for it.
const STEPS_BEFORE_POINT_CONTACT: usize = 3;

/// Newton steps times nodes that are spent on a cable from one guess. Less: cables with ten
/// contacts are left to a chain of bars; more: seconds go into what is not found. Chosen so that a
/// guess costs some tenths of a second; not tuned further.
const MOST_WORK: usize = 25_000;

/// Newton has ended where no unknown moves by more than this part of its size.
const STEP_TOLERANCE: f64 = 1e-10;

/// Part of an unknown's size by which it is moved to find a slope, with central differences: their
/// error is its square.
const DIFFERENCE_STEP: f64 = 1e-6;

/// A surface on which the cable can lie, at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Contact {
    /// Index of the obstacle in the scene, or of the pulley among the supports.
    owner: Owner,
    /// Centre of a round, or a point of the line, m, where the centre line of the cable runs.
    at: Vec2,
    /// Radius of the cable's centre line, m; None: a line.
    radius: Option<f64>,
    /// Outward normal of a line.
    normal: Vec2,
    /// +1 passed anticlockwise, −1 clockwise.
    sense: f64,
    /// Friction mobilised: force along growing arc length over normal force.
    mobilised: f64,
    /// True if that is all there is.
    slips: bool,
}

/// The owner of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Owner {
    Obstacle(usize),
    Pulley(usize),
}

/// Residuals of some states, appended.
type Residual<'a> = dyn Fn(&[[f64; STATES]], &mut Vec<f64>) + 'a;

impl Contact {
    /// Gap (m) and outward normal at a place.
    fn gap(&self, x: Vec2) -> (f64, Vec2) {
        let d = x - self.at;
        match self.radius {
            None => (d.dot(&self.normal), self.normal),
            Some(radius) => {
                let far = d.norm();
                if far > 0.0 { (far - radius, d / far) } else { (-radius, self.normal) }
            }
        }
    }

    /// Curvature of what it offers, with its sign, 1/m.
    fn curvature(&self) -> f64 {
        self.radius.filter(|r| *r > 0.0).map_or(0.0, |r| self.sense / r)
    }

    /// True if it is a point that the cable slides over, which no cable can lie on.
    fn is_point(&self) -> bool {
        self.radius == Some(0.0)
    }
}

/// A piece of cable between two joints.
#[derive(Clone, Debug)]
struct Piece {
    /// The contact it lies on; None: it is free.
    lies: Option<usize>,
    /// Places of its nodes, 0 to 1.
    grid: Vec<f64>,
    nodes: Vec<[f64; STATES]>,
}

/// A point where two pieces meet.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Joint {
    /// A contact in one point.
    ContactPair(usize),
    /// A stretch of contact begins.
    Begin(usize),
    /// It ends.
    End(usize),
    /// Held at a place of the cable (m) and of the plane (m), in a direction (rad) where it is
    /// clamped.
    Held(usize, f64, Vec2, Option<f64>),
    /// A dead load at a place of the cable, N; with the support it is, if it is one.
    Load(Option<usize>, f64, Vec2),
}

/// An end of the cable.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// Held, in a direction (rad) where it is clamped.
    Held(Vec2, Option<f64>),
    /// Under a dead load, N.
    Loaded(Vec2),
}

/// A cable at rest.
#[derive(Clone, Debug)]
pub struct Elastica {
    axial_stiffness: f64,
    /// The bending stiffness at present, N·m².
    bending: f64,
    thermal_stretch: f64,
    body: Vec2,
    length: f64,
    /// Forces of the scene, N.
    scale: f64,
    pieces: Vec<Piece>,
    joints: Vec<Joint>,
    ends: [End; 2],
    contacts: Vec<Contact>,
    /// Newton steps so far.
    pub steps: usize,
    /// The same times nodes.
    work: usize,
    residual: f64,
    /// The piece that Newton's method wanted to be shorter than nothing.
    shrinking: Option<usize>,
}

fn place(u: &[f64; STATES]) -> Vec2 {
    Vec2::new(u[0], u[1])
}

fn tangent(u: &[f64; STATES]) -> Vec2 {
    Vec2::new(u[ANGLE].cos(), u[ANGLE].sin())
}

fn force(u: &[f64; STATES]) -> Vec2 {
    Vec2::new(u[4], u[5])
}

fn tension(u: &[f64; STATES]) -> f64 {
    force(u).dot(&tangent(u))
}

/// The angle from a line's or round's own direction, as a sine: zero where the cable is tangent.
fn slant(contact: &Contact, u: &[f64; STATES]) -> f64 {
    contact.gap(place(u)).1.dot(&tangent(u))
}

/// The resting place of a stiff cable in contact, from the answer for a flexible one where there is
/// one: as an elastica where that is found, else as a chain of bars with what halving them changes
/// as its error.
pub fn rest(
    problem: &Problem,
    time_s: f64,
    dragged: &[Option<Vec2>],
    lay: Option<&CableSolution>,
    tolerance: f64,
) -> Option<(CableSolution, Cost)> {
    let bent = lay.and_then(|lay| Elastica::from_flexible(problem, time_s, dragged, lay));
    let bent = bent.and_then(|e| e.answer(problem, tolerance));
    let bent = bent.filter(|(found, _)| lay.is_some_and(|lay| keeps_sides(problem, &lay.nodes, found)));
    let chain = match &bent {
        // An equilibrium may be one that a cable runs away from: a chain that is let go there
        // tells.
        Some((answer, _)) => match relax::settle_chain(problem, time_s, dragged, answer) {
            LetGo::Stays | LetGo::Unknown => return bent,
            LetGo::Leaves(chain) => *chain,
            LetGo::Totters => return None,
        },
        None => relax::relaxed(problem, time_s, dragged, lay)?,
    };
    let bend = |chain: &Chain<'_>| {
        let found = Elastica::from_chain(chain, dragged).and_then(|e| e.answer(problem, tolerance))?;
        keeps_sides(problem, &chain.nodes(), &found.0).then_some(found)
    };
    if let Some(found) = bend(&chain) {
        return Some(found);
    }
    let (fine, rests) = chain.halved(dragged)?;
    if let Some(found) = if rests { bend(&fine) } else { None } {
        return Some(found);
    }
    let cost = Cost { iterations: chain.steps + fine.steps, ..Cost::default() };
    let (coarse, finer) = (chain.solution(), fine.solution());
    let errors = ErrorEstimates::between(&coarse, &finer);
    Some((if rests { finer } else { coarse }.known_to(errors), cost))
}

/// True if a cable can have come from one shape to an answer without passing through an obstacle.
/// Newton's method can: where a contact of the way up in stiffness would have to pull it is let go,
/// and what springs off a post may come to rest on its other side.
fn keeps_sides(problem: &Problem, from: &[Node], to: &CableSolution) -> bool {
    let [old, new] = [from, &to.nodes].map(|nodes| nodes.iter().map(Node::at).collect::<Vec<Vec2>>());
    swept_corners::through(&swept_corners::corners(&problem.world), &old, &new, &mut Vec::new()).is_none()
}

impl Elastica {
    /// The answer with its error, at the whole stiffness.
    fn answer(mut self, problem: &Problem, tolerance: f64) -> Option<(CableSolution, Cost)> {
        if !self.stiffen(problem) {
            return None;
        }
        let (estimate, errors) = self.refine(problem, tolerance)?;
        let (iterations, residual_n) = self.cost();
        let answer = CableSolution { error_estimate: Some(estimate), errors, ..self.solution(problem) };
        Some((answer, Cost { iterations, residual_n, ..Cost::default() }))
    }

    /// Force of a contact along its normal, per unstretched metre, on a piece that lies on it, N/m.
    fn pressure(&self, contact: &Contact, u: &[f64; STATES]) -> f64 {
        let t = tangent(u);
        let pull = force(u).dot(&t);
        let turn = self.thermal_stretch * (1.0 + pull / self.axial_stiffness) * contact.curvature();
        contact.sense * (pull * turn + self.body.dot(&perp(t)))
    }

    /// The slope of all unknowns along a piece.
    fn slope(&self, lies: Option<usize>, u: &[f64; STATES]) -> [f64; STATES] {
        let (t, f) = (tangent(u), force(u));
        let n = perp(t);
        let pull = f.dot(&t);
        let stretch = self.thermal_stretch * (1.0 + pull / self.axial_stiffness);
        let l = u[LENGTH];
        let [turn, moment, df] = match lies.and_then(|k| self.contacts.get(k)) {
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
    fn element(&self, lies: Option<usize>, h: f64, a: &[f64; STATES], b: &[f64; STATES]) -> [f64; STATES] {
        let (fa, fb) = (self.slope(lies, a), self.slope(lies, b));
        let middle = std::array::from_fn(|i| 0.5 * (a[i] + b[i]) + 0.125 * h * (fa[i] - fb[i]));
        let fm = self.slope(lies, &middle);
        std::array::from_fn(|i| b[i] - a[i] - h / 6.0 * (fa[i] + 4.0 * fm[i] + fb[i]))
    }

    /// The equations at an end of the cable; `lies`: the contact that its piece lies on.
    fn end(&self, which: usize, lies: Option<usize>, u: &[f64; STATES], out: &mut Vec<f64>) {
        out.push(u[ARC] - if which == 0 { 0.0 } else { self.length });
        let sign = if which == 0 { -1.0 } else { 1.0 };
        let contact = lies.and_then(|k| self.contacts.get(k));
        if let (0, Some(c)) = (which, contact) {
            self.lie(c, u, out);
        }
        match (self.ends[which], contact) {
            // An end that lies on a contact is led: only its place along the contact or its pull is
            // free.
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

    /// Force of a contact on an end that lies on it, along its normal, N: the load of that end
    /// presses there in one point.
    fn tip_push(&self, which: usize, c: &Contact, u: &[f64; STATES]) -> f64 {
        match self.ends[which] {
            End::Loaded(load) => c.sense * load.dot(&perp(tangent(u))),
            End::Held(..) => 0.0,
        }
    }

    /// The four conditions under which a piece lies on its contact: all of it does where its start
    /// does.
    fn lie(&self, c: &Contact, u: &[f64; STATES], out: &mut Vec<f64>) {
        let bent = self.bending * c.curvature() * (1.0 + tension(u) / self.axial_stiffness);
        out.extend([c.gap(place(u)).0, slant(c, u), u[MOMENT] - bent, force(u).dot(&perp(tangent(u)))]);
    }

    /// The equations where two pieces meet.
    fn joint(&self, joint: Joint, a: &[f64; STATES], b: &[f64; STATES], out: &mut Vec<f64>) {
        let jump = |c: &Contact| {
            let (t, d) = (tangent(a), force(b) - force(a));
            let normal = perp(t) * -c.sense;
            d.dot(&t) - c.mobilised * d.dot(&normal)
        };
        let (xa, xb) = (place(a), place(b));
        match joint {
            Joint::ContactPair(k) | Joint::Begin(k) | Joint::End(k) => {
                out.extend((0..=MOMENT).map(|i| b[i] - a[i]));
                out.push(b[ARC] - a[ARC]);
                let Some(c) = self.contacts.get(k) else { return };
                out.push(jump(c));
                match joint {
                    Joint::ContactPair(_) if c.is_point() => out.extend([(xa - c.at).x, (xa - c.at).y]),
                    Joint::ContactPair(_) => out.extend([c.gap(xa).0, slant(c, a)]),
                    Joint::Begin(_) => self.lie(c, b, out),
                    _ => {}
                }
            }
            Joint::Held(_, s, at, angle) => {
                out.extend([a[ARC] - s, b[ARC] - s, (xa - at).x, (xa - at).y, (xb - at).x, (xb - at).y]);
                match angle {
                    Some(angle) => out.extend([a[ANGLE] - angle, b[ANGLE] - angle]),
                    None => out.extend([b[ANGLE] - a[ANGLE], b[MOMENT] - a[MOMENT]]),
                }
            }
            Joint::Load(_, s, load) => {
                let d = force(b) - force(a) + load;
                out.extend([a[ARC] - s, b[ARC] - s, d.x, d.y]);
                out.extend((0..=MOMENT).map(|i| b[i] - a[i]));
            }
        }
    }

    /// The size by which each unknown is measured.
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

    /// Solves all equations at the present set of contacts; false where that does not end.
    fn newton(&mut self) -> bool {
        let mut wanting = vec![0; self.pieces.len()];
        self.shrinking = None;
        for _ in 0..MAX_STEPS {
            self.work += self.pieces.iter().map(|p| p.nodes.len()).sum::<usize>();
            if self.work > MOST_WORK {
                return false;
            }
            let sizes = self.sizes();
            let Some(step) = self.step(&sizes) else { return false };
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
                    p.lies.is_some() && k > 0 && k + 1 < wanting.len() && -step[at + LENGTH] > p.nodes[0][LENGTH];
                wanting[k] = if gone { wanting[k] + 1 } else { 0 };
                at += STATES * p.nodes.len();
            }
            self.shrinking = wanting.iter().position(|w| *w >= STEPS_BEFORE_POINT_CONTACT);
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

    /// One Newton step for all unknowns.
    fn step(&mut self, sizes: &[f64; STATES]) -> Option<Vec<f64>> {
        let count: usize = self.pieces.iter().map(|p| p.nodes.len()).sum();
        let mut band = Band::new(STATES * count, HALF_BAND);
        let mut right: Vec<f64> = Vec::with_capacity(STATES * count);
        let last = self.pieces.len() - 1;
        let (mut first, mut column) = (Vec::new(), 0);
        // The equations of one place as a function of one or two nodes, with their slopes.
        let mut add = |column: usize, near: &[[f64; STATES]], of: &Residual<'_>| {
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
                        band.set(row + r, column + j, slope);
                    }
                }
            }
        };
        for (k, piece) in self.pieces.iter().enumerate() {
            if k == 0 {
                add(column, &piece.nodes[..1], &|u, out| self.end(0, piece.lies, &u[0], out));
            }
            for (e, pair) in piece.nodes.windows(2).enumerate() {
                let h = piece.grid[e + 1] - piece.grid[e];
                add(column, pair, &|u, out| out.extend(self.element(piece.lies, h, &u[0], &u[1])));
                column += STATES;
            }
            first.clear();
            first.extend(piece.nodes.last());
            if k == last {
                add(column, &first, &|u, out| self.end(1, piece.lies, &u[0], out));
            } else {
                first.extend(self.pieces[k + 1].nodes.first());
                let joint = self.joints[k];
                add(column, &first, &|u, out| self.joint(joint, &u[0], &u[1], out));
            }
            column += STATES;
        }
        if right.len() != STATES * count {
            return None;
        }
        self.residual = right.iter().fold(0.0, |m: f64, r| if r.abs() <= m { m } else { r.abs() });
        right.iter_mut().for_each(|r| *r = -*r);
        band.solve(&mut right).then_some(right)
    }
}

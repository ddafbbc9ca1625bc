//! A bend is judged by its radius, its place and the obstacle or support that guides the cable
//! there.
//!
//! The tightest bend of an answer is the greatest curvature anywhere on its line, free or guided. A
//! cable round a wheel or a post has the radius of its centre line there, round a sharp corner its
//! own radius (the turn of the corner per element would only tell how fine the mesh is). Pressure
//! on the round is q = T/R per metre.
//!
//! The bend of a cable at a sharp corner is judged by its bending stiffness EI, known or estimated,
//! also where the answer is that of a flexible line. Weightless beside the corner, with φ the angle
//! to the direction in which it leaves far away and T the tension there, moments balance by EI φ''
//! = T sin φ. Times φ' and integrated from far away, where φ = φ' = 0:
//!
//! ```text
//! EI φ'²/2 = T (1 − cos φ)    so    κ = φ' = 2 √(T/EI) sin(φ/2)
//! ```
//!
//! and along the line the tension is T cos φ, so that T cos φ + EI κ²/2 = T holds everywhere (the
//! first integral of Euler's elastica; A. E. H. Love, A Treatise on the Mathematical Theory of
//! Elasticity, 4th ed., 1927, art. 262). A corner that turns the cable by θ pushes at the point
//! where φ = θ/2 from both sides: there the bend is sharpest, with the radius ρ = ½ √(EI/T) /
//! sin(θ/4). Where ρ is less than that of the corner's own arc, the cable lies on that arc.
//! A round post or wheel is such a corner with a larger arc.
//!
//! A cable that hangs in a narrow loop is kept open by its bending stiffness, too: with both legs
//! straight up and no tension at the bottom, EI θ'' = −w s cos θ with θ(0) = 0, θ → π/2 has the
//! radius 0.912 (EI/w)^⅓ there; any wider loop has a larger one.
//!
//! The bars of a stiff cable in motion may be longer than that bend. They spread its turn over
//! their length and show it too gentle by up to two times, so the formula judges it there, too.

use super::guide_at_node::{Guide, guide_at_node};
use super::tangle::turns;
use crate::math::{larger, smaller};
use crate::problem::Problem;
use crate::solution::{Bend, CableSolution, JudgedBend, Node, Pressure, Warning, WarningCause};

/// Least turn at a sharp corner that bends a cable of unknown bending stiffness to the corner's
/// radius, rad: 15°. Less is spread by the stiffness that every cable has; more lets sharp bends
/// pass. Over 15° a cable of diameter d leaves the corner within d/4 of its line.
const CORNER_TURN: f64 = 0.26;

/// A stiff cable whose line has no more than this times the radius of a corner's or post's own arc
/// may have been given no moment there: its mesh follows the arc. Closer to 1: rounding passes for
/// a moment; further: bends that are as sharp are judged by the formula, which says the same.
const CORNER_ARC_RATIO: f64 = 1.05;

/// Length of the bars beside a node of a stiff cable in motion, in bending lengths √(EI/T), above
/// which they do not show a led bend as sharp as it is. Smaller: bends that bars show are judged by
/// the formula, which does not know what else is near; larger: bends up to 1.8 times too gentle
/// (6 of 19 random bends over corners and posts).
const COARSE_BAR_LENGTHS: f64 = 0.5;

/// Radius at the bottom of the narrowest loop that hangs by its own weight w, in units of (EI/w)^⅓:
/// the solution of the equation at the head of this file. It is no setting.
const NARROWEST_LOOP_RADIUS: f64 = 0.912;

/// Greatest centripetal acceleration, in parts of that of the weight, of a loop that hangs by its
/// weight. Larger: whirling loops are taken for hanging ones; smaller: slowly moved ones are not.
const MAX_HANGING_ACCELERATION: f64 = 0.25;

/// Distance from a corner, in bending lengths √(EI/T), within which a cable makes nearly all of its
/// turn there: tan(φ/4) falls by e a bending length. Smaller: parts of the turn are left out;
/// larger: the turns of other corners are counted.
const BEND_REACH_LENGTHS: f64 = 3.0;

/// Least turn between two elements of a flexible cable that is a bend, rad. Less is a radius of a
/// hundred elements.
const MIN_TURN: f64 = 0.01;

/// Radius of a free bend that is a kink where the cable states no smallest radius, in diameters: a
/// round cable bent to less than its own width flattens.
const KINK_DIAMETERS: f64 = 1.0;

/// Radius of a bend from which the cable is straight, in lengths of the cable, which turns by less
/// than a billionth of a radian then: that is rounding of its nodes.
const STRAIGHT_LENGTHS: f64 = 1e9;

/// The quality with which the line of an answer shows a bend at a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ShownBend {
    /// It has the curvature of the cable, or that of a flexible one.
    Exact,
    /// It consists of bars short enough to show the bend.
    FineBars,
    /// It consists of bars that are too long for it.
    CoarseBars,
}

impl ShownBend {
    /// The quality with which the line shows a bend at node `k` of a piece.
    fn of(problem: &Problem, answer: &CableSolution, piece: &[Node], k: usize) -> Self {
        if !answer.assumptions.inertia || problem.bending_stiffness == 0.0 {
            return Self::Exact;
        }
        let bar = |a: usize, b: usize| Some(piece.get(b)?.arc_length_m - piece.get(a)?.arc_length_m);
        let longest = larger(k.checked_sub(1).and_then(|a| bar(a, k)).unwrap_or(0.0), bar(k, k + 1).unwrap_or(0.0));
        let pull = piece.get(k).map_or(0.0, |n| larger(n.tension_n, 0.0));
        let coarse = longest * longest * pull > COARSE_BAR_LENGTHS * COARSE_BAR_LENGTHS * problem.bending_stiffness;
        if coarse { Self::CoarseBars } else { Self::FineBars }
    }
}

/// The sharpest bends of an answer, and the greatest pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SharpestBends {
    /// The sharpest of the answer's line.
    line: Option<Bend>,
    /// The sharpest that the cable has with its bending stiffness where nothing leads it.
    free: Option<Bend>,
    /// The sharpest led one that the cable has with its bending stiffness.
    judged: Option<Bend>,
    /// The bending stiffness by which it is judged, N·m²; 0 = none is known.
    bending_stiffness: f64,
    /// The greatest pressure.
    pub pressure: Option<Pressure>,
}

impl SharpestBends {
    /// Looks for them.
    pub fn of(problem: &Problem, answer: &CableSolution) -> Self {
        let bending_stiffness = problem.cable.likely_bending_stiffness_n_m2();
        let mut this = Self { bending_stiffness, ..Self::default() };
        let led = !answer.contacts.is_empty() || problem.supports.iter().any(|s| s.wheel_radius > 0.0);
        let (mut sharpest, mut start) = (0.0, 0);
        for piece in answer.pieces() {
            let turns = turns(piece);
            for (k, n) in piece.iter().enumerate() {
                let turn = |k: Option<usize>| k.and_then(|k| turns.get(k)).copied().unwrap_or(0.0);
                let (own, curvature) = (turn(Some(k)), n.curvature_per_m.abs());
                // A search for the body that leads a node is dear: it is made where the answer can
                // change what was found so far.
                let presses = led && curvature * n.tension_n > this.pressure.map_or(0.0, |p| p.pressure_n_per_m);
                if own.abs() < MIN_TURN && !(curvature > sharpest) && !presses && problem.bending_stiffness == 0.0 {
                    continue;
                }
                // A corner between two nodes is shared by them, a round by all that lie on it.
                let pair = (own + turn(k.checked_sub(1))).abs().max((own + turn(Some(k + 1))).abs());
                let guide_at_node = guide_at_node(problem, answer, start + k);
                let shown = ShownBend::of(problem, answer, piece, k);
                let shared = match guide_at_node {
                    Guide::Round(radius) | Guide::Corner(radius) => {
                        let quarter = std::f64::consts::FRAC_PI_2 * radius;
                        let far =
                            if shown == ShownBend::Exact { quarter } else { larger(quarter, bend_reach(problem, n)) };
                        larger(pair, turn_within(piece, &turns, k, far))
                    }
                    _ => pair,
                };
                if guide_at_node == Guide::Free && curvature > sharpest {
                    sharpest = curvature;
                }
                this.add(problem, n, guide_at_node, shared, shown);
            }
            start += piece.len();
        }
        this
    }

    /// The sharpest of the answer's line.
    pub fn tightest(&self) -> Option<Bend> {
        self.line
    }

    /// The sharpest led bend that the cable has with its bending stiffness.
    pub fn judged(&self) -> Option<JudgedBend> {
        self.judged.map(|bend| JudgedBend { bend, bending_stiffness_n_m2: self.bending_stiffness })
    }

    /// The sharpest that the cable has with its bending stiffness where nothing leads it.
    pub fn free(&self) -> Option<Bend> {
        self.free
    }

    /// The least radius (m) with which the cable hangs in a loop by its weight at a node, if its
    /// line is that of a flexible one; 0 where it may be bent more sharply.
    fn loop_radius(&self, problem: &Problem, n: &Node) -> f64 {
        let weight = problem.weight.norm();
        // In a pile the cable is pressed into folds by what lies on it.
        if problem.cable.self_contact
            || problem.bending_stiffness > 0.0
            || !(self.bending_stiffness > 0.0 && weight > 0.0)
        {
            return 0.0;
        }
        let radius = NARROWEST_LOOP_RADIUS * (self.bending_stiffness / weight).cbrt();
        let square = n.vx_m_per_s * n.vx_m_per_s + n.vy_m_per_s * n.vy_m_per_s;
        let hangs = problem.linear_density * square < MAX_HANGING_ACCELERATION * weight * radius;
        if hangs { radius } else { 0.0 }
    }

    /// Takes a node into account, which turns the cable by `turn` (rad).
    fn add(&mut self, problem: &Problem, n: &Node, guide_at_node: Guide, turn: f64, shown: ShownBend) {
        let stiff = problem.bending_stiffness > 0.0;
        let own = 1.0 / n.curvature_per_m.abs();
        let line = match guide_at_node {
            Guide::Free => own,
            Guide::Held if !stiff => return,
            Guide::Round(_) if !stiff && turn < MIN_TURN => return,
            Guide::Round(radius) if !stiff => radius,
            Guide::Corner(radius) if !stiff && turn >= CORNER_TURN && radius < own => radius,
            _ => own,
        };
        let bend = |radius_m: f64| Bend { radius_m, arc_length_m: n.arc_length_m, x_m: n.x_m, y_m: n.y_m };
        let keep = |sharpest: &mut Option<Bend>, radius_m: f64| {
            let bends = radius_m > 0.0 && radius_m < STRAIGHT_LENGTHS * problem.length;
            if bends && sharpest.is_none_or(|b| radius_m < b.radius_m) {
                *sharpest = Some(bend(radius_m));
            }
        };
        if guide_at_node == Guide::Free {
            let hanging = larger(line, self.loop_radius(problem, n));
            keep(&mut self.free, hanging);
            keep(&mut self.line, line);
            return;
        }
        keep(&mut self.line, line);
        let judged = match guide_at_node {
            Guide::Corner(radius) | Guide::Round(radius) if shown != ShownBend::Exact => {
                let bend = larger(radius, corner_radius(problem.bending_stiffness, n.tension_n, turn));
                match shown {
                    _ if own <= CORNER_ARC_RATIO * radius => bend,
                    ShownBend::CoarseBars => smaller(own, bend),
                    _ => own,
                }
            }
            Guide::Corner(radius) if stiff && own > CORNER_ARC_RATIO * radius => own,
            Guide::Round(_) if stiff => line,
            Guide::Corner(radius) | Guide::Round(radius) if self.bending_stiffness > 0.0 => {
                larger(radius, corner_radius(self.bending_stiffness, n.tension_n, turn))
            }
            Guide::Corner(_) if turn < CORNER_TURN => f64::INFINITY,
            _ => line,
        };
        keep(&mut self.judged, judged);
        let round = match guide_at_node {
            Guide::Round(radius) => Some(radius),
            Guide::Corner(radius) if turn >= CORNER_TURN => Some(radius),
            _ => None,
        };
        let Some(radius_m) = round.map(|radius| if stiff { own } else { radius }).filter(|r| r.is_finite() && *r > 0.0)
        else {
            return;
        };
        let newtons_per_m = n.tension_n / radius_m;
        if self.pressure.is_none_or(|p| newtons_per_m > p.pressure_n_per_m) {
            self.pressure = Some(Pressure {
                pressure_n_per_m: newtons_per_m,
                arc_length_m: n.arc_length_m,
                x_m: n.x_m,
                y_m: n.y_m,
            });
        }
    }
}

/// Radius (m) of the sharpest bend of a cable with a bending stiffness (N·m²) and a tension (N) at
/// a sharp corner that turns it by `turn` (rad), see the head of this file: infinite where it is
/// not pulled.
pub(super) fn corner_radius(bending_stiffness: f64, tension: f64, turn: f64) -> f64 {
    let (pull, sine) = (larger(tension, 0.0), (0.25 * turn).sin().abs());
    0.5 * (bending_stiffness / pull).sqrt() / sine
}

/// The distance from a corner within which a cable with bending stiffness makes nearly all of its
/// turn there, m.
fn bend_reach(problem: &Problem, n: &Node) -> f64 {
    let reach = BEND_REACH_LENGTHS * (problem.bending_stiffness / larger(n.tension_n, 0.0)).sqrt();
    if reach < problem.length { reach } else { problem.length }
}

/// Returns how far the nodes turn that are within a distance (m) of node `k`, rad.
fn turn_within(piece: &[Node], turns: &[f64], k: usize, far: f64) -> f64 {
    let near = |n: &Node| piece.get(k).is_some_and(|at| (n.arc_length_m - at.arc_length_m).abs() <= far);
    let first = piece[..k].iter().rposition(|n| !near(n)).map_or(0, |i| i + 1);
    let count = piece[first..].iter().take_while(|n| near(n)).count();
    turns.get(first..first + count).unwrap_or_default().iter().sum::<f64>().abs()
}

/// Appends bends sharper than the cable stands, free and led, and pressure beyond its limit.
pub(super) fn warn(problem: &Problem, bends: &SharpestBends, out: &mut Vec<Warning>) {
    let cable = &problem.cable;
    let stated = cable.min_bend_radius_m;
    let kink = if stated > 0.0 { stated } else { KINK_DIAMETERS * cable.diameter_m };
    let mut warn = |cause, b: Bend, limit: f64| {
        let warning = Warning::new(cause, &cable.name, b.arc_length_m, [b.radius_m, limit]);
        out.push(warning.at([b.x_m, b.y_m]));
    };
    if let Some(b) = bends.judged.filter(|b| b.radius_m < stated) {
        warn(WarningCause::NarrowGuide, b, stated);
    }
    if let Some(b) = bends.free.filter(|b| b.radius_m < kink) {
        warn(WarningCause::FreeKink, b, kink);
    }
    let limit = cable.sidewall_limit_n_per_m;
    if let (Some(p), Some(limit)) = (bends.pressure, limit)
        && p.pressure_n_per_m > limit
    {
        let warning = Warning::new(WarningCause::Pressure, &cable.name, p.arc_length_m, [p.pressure_n_per_m, limit]);
        out.push(warning.at([p.x_m, p.y_m]));
    }
}

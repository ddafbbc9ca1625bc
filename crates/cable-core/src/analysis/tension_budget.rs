//! A tension budget divides a tension into its causes: it sums the changes of tension between an
//! end of the cable and a place on it.
//!
//! Along a cable at rest dT/ds = −q·t − r, with the weight and wind q per metre of arc length, the
//! tangent t and friction r. With dx = (1 + ε) θ t ds, θ = 1 + αΔT, the weight on a piece Δx adds
//! −q·Δx / ((1 + ε) θ): for an inextensible cable the well-known w Δy. So
//!
//! ```text
//! T(place) = T(end) + Σ −q·Δx / ((1 + ε) θ) + what is left of each piece
//! ```
//!
//! and the remainder belongs to the contact, pulley, grip or load on which the piece lies. If it
//! lies on none of them, the remainder is the rest: inertia, shear of a stiff cable, the floor of a
//! plan view, the mesh. The terms add up to the tension by construction; a test compares each with
//! the contacts of an answer.

use crate::math::Vec2;
use crate::problem::TimeSeries;
use crate::scene::{Scene, SupportKind, View};
use crate::solution::{CableSolution, Node, Solution};

/// Distance below which two places are the same, as a fraction of the cable's length.
const PLACE_TOLERANCE: f64 = 1e-9;

/// The end of the cable (of the piece of it that holds the place) at which the sum begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StartEnd {
    /// The one with less tension.
    #[default]
    Slacker,
    /// Arc length 0, or where the piece begins.
    Start,
    /// The other end.
    End,
}

/// A cause that adds to a tension or takes from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Tension at the end the sum begins at.
    End,
    /// The cable's weight.
    Weight,
    /// Wind or stream.
    Wind,
    /// Friction of a contact: index in the answer's contacts.
    Contact(usize),
    /// A pulley's friction, or the force of a grip: index of the support.
    Support(usize),
    /// A point load: index in the scene's loads.
    Load(usize),
    /// Everything else: inertia, shear, the floor of a plan view, the mesh.
    Rest,
}

/// One term of the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// Its cause.
    pub cause: Cause,
    /// The tension it adds, N; below 0 it takes away.
    pub tension_n: f64,
    /// Ratio of the tension after the cause to that before it, on the way from the end: for a
    /// contact the factor e^{±μφ}. None if the cause has no place, or no tension before it.
    pub factor: Option<f64>,
}

/// A tension and its contributions, in the order they are met on the way from the end; weight, wind
/// and rest follow.
#[derive(Clone, Debug, PartialEq)]
pub struct TensionBudget {
    /// Its place, m of arc length.
    pub arc_length_m: f64,
    /// Tension there, N: the sum of the contributions.
    pub tension_n: f64,
    /// The place at which the sum begins, m of arc length.
    pub from_m: f64,
    /// The contributions.
    pub contributions: Vec<Contribution>,
}

/// Something that changes the tension at a place.
struct LocalSource {
    cause: Cause,
    /// Its start and end, m.
    extent: [f64; 2],
    /// The change of tension that is known, N.
    jump: f64,
    /// Tensions before and after it along growing arc length, N, where the answer has them.
    sides: Option<[f64; 2]>,
    sum: f64,
    /// Tensions on the two sides of it on the way, N.
    passed: Option<[f64; 2]>,
}

/// A load spread along a cable.
struct DistributedLoad {
    weight: Vec2,
    wind: Vec2,
    thermal_stretch: f64,
}

/// Returns the budget of the tension of a cable (by index) at an arc length (m). None without an
/// answer there.
#[must_use]
pub fn tension_budget(
    scene: &Scene,
    solution: &Solution,
    cable: usize,
    arc_length_m: f64,
    from: StartEnd,
) -> Option<TensionBudget> {
    let solved = solution.cables.get(cable)?;
    let load = distributed_load(scene, cable, solution.time_s)?;
    let mut sources = sources(scene, cable, solved);
    let path = path(solved, arc_length_m, from)?;
    let (first, last) = (path.first()?, path.last()?);
    let whole = solved.nodes.last().map_or(0.0, |n| n.arc_length_m);
    let (mut weight, mut wind, mut rest) = (0.0, 0.0, 0.0);
    for pair in path.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let dx = Vec2::new(b.x_m - a.x_m, b.y_m - a.y_m);
        let stretch = load.thermal_stretch * (1.0 + 0.5 * (a.strain + b.strain));
        let (by_weight, by_wind) = (-load.weight.dot(&dx) / stretch, -load.wind.dot(&dx) / stretch);
        weight += by_weight;
        wind += by_wind;
        let left = (b.tension_n - a.tension_n) - by_weight - by_wind;
        match source_under(&mut sources, [a.arc_length_m, b.arc_length_m], PLACE_TOLERANCE * whole) {
            Some(source) => {
                source.sum += left;
                let before = source.passed.map_or(a.tension_n, |[before, _]| before);
                source.passed = Some([before, b.tension_n]);
            }
            None => rest += left,
        }
    }
    let plain = |cause, tension_n| Contribution { cause, tension_n, factor: None };
    let mut contributions = vec![plain(Cause::End, first.tension_n)];
    let forward = first.arc_length_m <= last.arc_length_m;
    let [low, high] = if forward { [first, last] } else { [last, first] }.map(|n| n.arc_length_m);
    if !forward {
        sources.reverse();
    }
    for source in sources {
        let Some([before, after]) = source.passed else { continue };
        // If a source is passed completely, the values of the answer are more accurate than the
        // nodes nearest to its ends.
        let whole = source.extent.iter().all(|s| (low..=high).contains(s));
        let [before, after] = match source.sides.filter(|_| whole) {
            Some([a, b]) if forward => [a, b],
            Some([a, b]) => [b, a],
            None => [before, after],
        };
        let factor = (before > 0.0).then(|| after / before);
        contributions.push(Contribution { cause: source.cause, tension_n: source.sum, factor });
    }
    contributions.extend([plain(Cause::Weight, weight), plain(Cause::Wind, wind), plain(Cause::Rest, rest)]);
    Some(TensionBudget {
        arc_length_m: last.arc_length_m,
        tension_n: contributions.iter().map(|t| t.tension_n).sum(),
        from_m: first.arc_length_m,
        contributions,
    })
}

/// Weight and wind of a cable at an instant (s), N per metre; None if there is no such cable.
fn distributed_load(scene: &Scene, cable: usize, time_s: f64) -> Option<DistributedLoad> {
    let (c, e) = (scene.cables.get(cable)?, &scene.environment);
    let weight = match scene.view {
        View::Elevation => Vec2::new(0.0, -c.linear_density_kg_per_m * e.gravity_m_per_s2),
        View::Plan => Vec2::zeros(),
    };
    let wind = match e.winds_n_per_m.len().min(e.wind_times_s.len()) {
        0 => Vec2::new(e.wind_n_per_m[0], e.wind_n_per_m[1]),
        n => TimeSeries::new(&e.wind_times_s[..n], &e.winds_n_per_m[..n]).at(time_s),
    };
    Some(DistributedLoad { weight, wind, thermal_stretch: 1.0 + c.thermal_expansion_per_k * e.temperature_change_k })
}

/// All that changes tension at a place, in order of arc length.
fn sources(scene: &Scene, cable: usize, solved: &CableSolution) -> Vec<LocalSource> {
    let source = |cause, extent, jump, sides| LocalSource { cause, extent, jump, sides, sum: 0.0, passed: None };
    let contacts = solved.contacts.iter().enumerate().map(|(k, c)| {
        let [before, after] = [c.tension_before_n, c.tension_after_n];
        source(Cause::Contact(k), c.extent_m(), (after - before).abs(), Some([before, after]))
    });
    let mut out: Vec<LocalSource> = contacts.collect();
    let ends = solved.supports.len().saturating_sub(1);
    let supports = scene.cables.get(cable).map_or(&[][..], |c| &c.supports);
    for (k, (r, s)) in solved.supports.iter().zip(supports).enumerate() {
        if k == 0 || k == ends {
            continue;
        }
        let lap = match s.kind {
            // The cable lies on the wheel for at most one turn of it.
            SupportKind::Pulley => std::f64::consts::PI * s.radius_m.unwrap_or(0.0),
            _ => 0.0,
        };
        let sides = r.tension_before_n.zip(r.tension_after_n).map(|(before, after)| [before, after]);
        let jump = sides.map_or(r.reaction_x_n.hypot(r.reaction_y_n), |[before, after]| (after - before).abs());
        out.push(source(Cause::Support(k), [r.arc_length_m - lap, r.arc_length_m + lap], jump, sides));
    }
    let name = scene.cables.get(cable).map_or("", |c| &c.name);
    for (k, load) in scene.loads.iter().enumerate().filter(|(_, l)| l.cable == name) {
        let force = load.force_n.or_else(|| load.forces_n.first().copied()).unwrap_or_default();
        out.push(source(Cause::Load(k), [load.arc_length_m; 2], force[0].hypot(force[1]), None));
    }
    out.sort_by(|a, b| (a.extent[0] + a.extent[1]).total_cmp(&(b.extent[0] + b.extent[1])));
    out
}

/// The source on which a piece between two arc lengths lies: the one with the longest common
/// length; of several that it only touches the one that changes the tension most.
fn source_under(sources: &mut [LocalSource], piece: [f64; 2], near: f64) -> Option<&mut LocalSource> {
    let [low, high] = if piece[0] <= piece[1] { piece } else { [piece[1], piece[0]] };
    let shared = |s: &LocalSource| high.min(s.extent[1]) - low.max(s.extent[0]);
    let rank = |s: &LocalSource| if shared(s) > near { [shared(s), 0.0] } else { [0.0, s.jump] };
    sources.iter_mut().filter(|s| shared(s) >= -near).max_by(|a, b| {
        let (a, b) = (rank(a), rank(b));
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    })
}

/// The nodes from the end at which the sum begins to the place, which is the last of them.
fn path(solved: &CableSolution, arc_length_m: f64, from: StartEnd) -> Option<Vec<Node>> {
    let piece = solved.pieces().filter(|p| p.len() >= 2).min_by(|a, b| {
        let off = |p: &[Node]| {
            let ends = [p[0].arc_length_m, p[p.len() - 1].arc_length_m];
            (ends[0] - arc_length_m).max(arc_length_m - ends[1]).max(0.0)
        };
        off(a).total_cmp(&off(b))
    })?;
    let (first, last) = (piece.first()?, piece.last()?);
    let at = arc_length_m.clamp(first.arc_length_m, last.arc_length_m);
    let forward = match from {
        StartEnd::Slacker => first.tension_n <= last.tension_n,
        StartEnd::Start => true,
        StartEnd::End => false,
    };
    let mut nodes: Vec<Node> = piece.to_vec();
    if !forward {
        nodes.reverse();
    }
    let beyond = |n: &Node| if forward { n.arc_length_m >= at } else { n.arc_length_m <= at };
    let k = nodes.iter().position(beyond)?;
    nodes.truncate(k + 1);
    if let [.., a, b] = nodes.as_mut_slice()
        && b.arc_length_m != at
    {
        *b = between(a, b, (at - a.arc_length_m) / (b.arc_length_m - a.arc_length_m));
        b.arc_length_m = at;
    }
    nodes.iter().all(|n| n.tension_n.is_finite()).then_some(nodes)
}

/// A node interpolated linearly between two nodes.
fn between(a: &Node, b: &Node, f: f64) -> Node {
    let mix = |x: f64, y: f64| x + (y - x) * f;
    Node {
        arc_length_m: mix(a.arc_length_m, b.arc_length_m),
        x_m: mix(a.x_m, b.x_m),
        y_m: mix(a.y_m, b.y_m),
        tension_n: mix(a.tension_n, b.tension_n),
        strain: mix(a.strain, b.strain),
        ..*a
    }
}

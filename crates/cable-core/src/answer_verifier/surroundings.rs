//! The surroundings are obstacles and robot of the verifier: edges and rounds, with distances by
//! brute force.
//!
//! The only optimisation is that edges are sorted by their left end, so that those in a box are
//! found without testing all.

use crate::contact::moving_outline::Outline;
use crate::math::{RigidPose, Vec2, cross, vec2};
use crate::problem::robot_outline;
use crate::scene::{LineEnds, Obstacle, Scene, Shape};
use crate::solution::RobotReport;

/// An edge of an obstacle, or a round (both ends in its centre).
#[derive(Clone, Copy, Debug)]
struct SolidEdge {
    from: Vec2,
    to: Vec2,
    /// Distance of the surface from the line or centre, m.
    thickness: f64,
    /// Index of the obstacle.
    body: usize,
    /// Lower left and upper right corner of the box about it, m.
    low: Vec2,
    high: Vec2,
}

impl SolidEdge {
    /// The obstacles of a scene, and the outline of its robot.
    fn new(from: Vec2, to: Vec2, thickness: f64, body: usize) -> Self {
        let around = Vec2::repeat(thickness);
        Self { from, to, thickness, body, low: from.inf(&to) - around, high: from.sup(&to) + around }
    }
}

/// Edges by their left ends.
#[derive(Clone, Debug)]
struct Edges {
    sorted: Vec<SolidEdge>,
    /// Greatest reach of an edge and its thickness along x, m: how far left of a box edges that
    /// meet it begin.
    widest: f64,
    /// Lower left and upper right corner of the box about them all, m.
    low: Vec2,
    high: Vec2,
}

impl Edges {
    fn new(mut sorted: Vec<SolidEdge>) -> Self {
        sorted.sort_by(|a, b| a.low.x.total_cmp(&b.low.x));
        let widest = sorted.iter().map(|e| e.high.x - e.low.x).fold(0.0, f64::max);
        let (low, high) = bounds(sorted.iter().flat_map(|e| [e.low, e.high]));
        Self { sorted, widest, low, high }
    }

    /// Returns whether all edges lie beside a box from `low` to `high`, m.
    fn is_clear_of_box(&self, low: Vec2, high: Vec2) -> bool {
        low.x > self.high.x || high.x < self.low.x || low.y > self.high.y || high.y < self.low.y
    }

    /// Those whose boxes meet a box from `low` to `high`, m.
    fn edges_in_box(&self, low: Vec2, high: Vec2) -> impl Iterator<Item = &SolidEdge> {
        let all = if self.is_clear_of_box(low, high) { &[][..] } else { &self.sorted[..] };
        let first = all.partition_point(|e| e.low.x < low.x - self.widest);
        let begun = all[first..].iter().take_while(move |e| e.low.x <= high.x);
        begun.filter(move |e| e.high.x >= low.x && e.low.y <= high.y && e.high.y >= low.y)
    }
}

/// The obstacles near each bar of a cable.
#[derive(Debug)]
pub(super) struct Neighbours {
    /// The first of `all` that belongs to each bar, and their number at the end.
    begins: Vec<usize>,
    all: Vec<NearestFeature>,
}

impl Neighbours {
    /// Of the lines from each of a chain of points to the next (m), within `reach` (m) of each.
    pub fn new(
        surroundings: &Surroundings<'_>,
        chain: impl ExactSizeIterator<Item = Vec2> + Clone,
        reach: f64,
    ) -> Self {
        let mut all = Vec::new();
        let (low, high) = bounds(chain.clone());
        if surroundings.is_clear_of_box(low - Vec2::repeat(reach), high + Vec2::repeat(reach)) {
            return Self { begins: Vec::new(), all };
        }
        let mut begins = Vec::with_capacity(chain.len());
        for (a, b) in chain.clone().zip(chain.skip(1)) {
            begins.push(all.len());
            surroundings.append_features_near(a, b, reach, &mut all);
        }
        begins.push(all.len());
        Self { begins, all }
    }

    /// Returns the obstacles near a bar.
    pub fn of(&self, bar: usize) -> &[NearestFeature] {
        self.between(bar, bar + 1)
    }

    /// Returns the obstacles near the bars between two nodes, and near the bar before and the bar
    /// after them.
    pub fn around(&self, from_node: usize, to_node: usize) -> &[NearestFeature] {
        self.between(from_node.saturating_sub(1), to_node + 1)
    }

    fn between(&self, from: usize, to: usize) -> &[NearestFeature] {
        let begin = |bar: usize| self.begins.get(bar).copied().unwrap_or(self.all.len());
        if self.all.is_empty() { &[] } else { self.all.get(begin(from)..begin(to)).unwrap_or_default() }
    }
}

/// An obstacle.
#[derive(Clone, Debug)]
struct SolidBody {
    name: String,
    /// Its own friction coefficient, where it has one.
    friction: Option<f64>,
    kind: FeatureKind,
}

/// The solid side of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FeatureKind {
    /// Below a line that runs from left to right.
    Below,
    /// Inside a closed line.
    Inside,
    /// The line itself, with its thickness.
    Line,
}

/// An obstacle near a piece of cable.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearestFeature {
    /// Index of the obstacle.
    pub body: usize,
    /// Distance of the centre line from the surface, m; 0 where they cross.
    pub distance: f64,
    /// Unit vector from the obstacle to the cable; zero where they cross.
    pub normal: Vec2,
    /// Nearest point of the cable, m.
    pub at: Vec2,
}

/// The obstacles of a scene, and last of all its robot.
#[derive(Clone, Debug)]
pub(super) struct Obstacles {
    bodies: Vec<SolidBody>,
    /// Of those that stand still.
    edges: Edges,
    outline: Option<Outline>,
}

impl Obstacles {
    /// The obstacles of a scene, and the outline of its robot.
    pub fn new(scene: &Scene) -> Self {
        let mut edges = Vec::new();
        let mut bodies: Vec<SolidBody> =
            scene.obstacles.iter().enumerate().map(|(k, o)| body(o, k, &mut edges)).collect();
        // A cable's own friction coefficient holds on the outline.
        let outline = robot_outline(scene, 0.0);
        bodies.extend(outline.as_ref().map(|o| SolidBody {
            name: o.name.clone(),
            friction: None,
            kind: FeatureKind::Inside,
        }));
        Self { bodies, edges: Edges::new(edges), outline }
    }

    /// The surroundings with the robot at its reported pose, or else at that of the scene.
    pub fn at(&self, robot: Option<&RobotReport>) -> Surroundings<'_> {
        let reported = robot.map(|r| RigidPose { at: Vec2::new(r.x_m, r.y_m), angle: r.pitch_deg.to_radians() });
        let edges = self.outline.iter().flat_map(|outline| {
            let body = self.bodies.len() - 1;
            let edges = outline.edges(reported.unwrap_or(outline.placement));
            edges.map(move |[from, to]| SolidEdge::new(from, to, 0.0, body))
        });
        Surroundings { bodies: &self.bodies, fixed: &self.edges, moving: Edges::new(edges.collect()) }
    }
}

/// The obstacles at an instant.
#[derive(Debug)]
pub(super) struct Surroundings<'a> {
    bodies: &'a [SolidBody],
    fixed: &'a Edges,
    moving: Edges,
}

impl Surroundings<'_> {
    /// Returns whether nothing is in a box from `low` to `high`, m, as all lies beside it.
    fn is_clear_of_box(&self, low: Vec2, high: Vec2) -> bool {
        self.fixed.is_clear_of_box(low, high) && self.moving.is_clear_of_box(low, high)
    }

    /// Edges whose boxes meet a box from `low` to `high`, m.
    fn edges_in_box(&self, low: Vec2, high: Vec2) -> impl Iterator<Item = &SolidEdge> {
        self.fixed.edges_in_box(low, high).chain(self.moving.edges_in_box(low, high))
    }

    pub fn name(&self, body: usize) -> &str {
        self.bodies.get(body).map_or("", |b| &b.name)
    }

    /// Index of the obstacle of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|b| b.name == name)
    }

    /// Coulomb friction of an obstacle with a cable whose own coefficient is `cable`.
    pub fn friction(&self, body: usize, cable: f64) -> f64 {
        self.bodies.get(body).and_then(|b| b.friction).unwrap_or(cable)
    }

    /// Appends the features within `reach` (m) of the straight line between two points: for each
    /// edge the nearest points of both lines, and the points nearest to the two ends.
    pub fn append_features_near(&self, a: Vec2, b: Vec2, reach: f64, out: &mut Vec<NearestFeature>) {
        let (low, high) = (a.inf(&b) - Vec2::repeat(reach), a.sup(&b) + Vec2::repeat(reach));
        for e in self.edges_in_box(low, high) {
            let t = e.thickness;
            if crosses(a, b, e.from, e.to) {
                out.push(NearestFeature { body: e.body, distance: -t, normal: Vec2::zeros(), at: crossing(a, b, e) });
                continue;
            }
            let far = (reach + t) * (reach + t);
            let pairs = closest(a, b, e.from, e.to);
            for (k, (p, q)) in pairs.iter().enumerate() {
                let way = p - q;
                let square = way.norm_squared();
                if square > far || pairs[..k].contains(&(*p, *q)) {
                    continue;
                }
                let apart = square.sqrt();
                let normal = if apart > 0.0 { way / apart } else { Vec2::zeros() };
                out.push(NearestFeature { body: e.body, distance: apart - t, normal, at: *p });
            }
        }
    }

    /// The obstacle in whose solid a point lies, and how deep, m.
    pub fn inside(&self, p: Vec2) -> Option<(usize, f64)> {
        // Each edge above the point counts: where it runs to the right its solid side is below it,
        // where to the left above.
        let mut above: Option<(usize, i32)> = None;
        let mut counts: Vec<(usize, i32)> = Vec::new();
        // Those that are nowhere above it do not count.
        for e in self.edges_in_box(p, Vec2::new(p.x, f64::INFINITY)) {
            if self.bodies.get(e.body).is_none_or(|b| b.kind == FeatureKind::Line) {
                continue;
            }
            let to_right = e.from.x <= p.x && p.x < e.to.x;
            let to_left = e.to.x <= p.x && p.x < e.from.x;
            if !(to_right || to_left) {
                continue;
            }
            let y = e.from.y + (e.to.y - e.from.y) * ((p.x - e.from.x) / (e.to.x - e.from.x));
            if y > p.y {
                let sign = if to_right { 1 } else { -1 };
                match &mut above {
                    None => above = Some((e.body, sign)),
                    Some((body, sum)) if *body == e.body => *sum += sign,
                    Some(_) => counts.push((e.body, sign)),
                }
            }
        }
        let mut all: Vec<(usize, i32)> = above.into_iter().collect();
        for (body, sign) in counts {
            match all.iter_mut().find(|c| c.0 == body) {
                Some(c) => c.1 += sign,
                None => all.push((body, sign)),
            }
        }
        let solid = |&(body, sum): &(usize, i32)| match self.bodies.get(body).map(|b| b.kind) {
            Some(FeatureKind::Below) => sum > 0,
            Some(FeatureKind::Inside) => sum != 0,
            _ => false,
        };
        let (body, _) = all.into_iter().find(solid)?;
        let distance = |e: &SolidEdge| {
            let q = nearest(p, e.from, e.to);
            (p - q).norm() - e.thickness
        };
        let all = self.fixed.sorted.iter().chain(&self.moving.sorted);
        let depth = all.filter(|e| e.body == body).map(distance).fold(f64::INFINITY, f64::min);
        Some((body, depth))
    }
}

/// Lower left and upper right corner of the box about some points, m.
fn bounds(points: impl Iterator<Item = Vec2>) -> (Vec2, Vec2) {
    let nowhere = (Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY));
    points.fold(nowhere, |(low, high), p| (low.inf(&p), high.sup(&p)))
}

/// The solid of an obstacle, whose edges are added to `edges`.
fn body(o: &Obstacle, index: usize, edges: &mut Vec<SolidEdge>) -> SolidBody {
    let mut line = |points: &[[f64; 2]], ends: LineEnds, thickness: f64| {
        let n = points.len();
        for k in 0..if ends == LineEnds::Joined { n } else { n.saturating_sub(1) } {
            let (from, to) = (vec2(points[k]), vec2(points[(k + 1) % n]));
            edges.push(SolidEdge::new(from, to, thickness, index));
        }
    };
    let kind = match &o.shape {
        Shape::Terrain { points_m } => {
            line(points_m, LineEnds::Open, 0.0);
            FeatureKind::Below
        }
        Shape::Polygon { points_m } => {
            line(points_m, LineEnds::Joined, 0.0);
            FeatureKind::Inside
        }
        Shape::Polyline { points_m, thickness_m } => {
            line(points_m, LineEnds::Open, 0.5 * thickness_m);
            FeatureKind::Line
        }
        Shape::Circle { center_m, radius_m } => {
            edges.push(SolidEdge::new(vec2(*center_m), vec2(*center_m), *radius_m, index));
            FeatureKind::Line
        }
    };
    SolidBody { name: o.name.clone(), friction: o.friction, kind }
}

/// The point of a straight line nearest to another, m.
pub(super) fn nearest(p: Vec2, a: Vec2, b: Vec2) -> Vec2 {
    let d = b - a;
    let square = d.norm_squared();
    let f = if square > 0.0 { ((p - a).dot(&d) / square).clamp(0.0, 1.0) } else { 0.0 };
    a + d * f
}

/// Pairs of nearest points of two lines that do not cross: seen from each end of the first, and
/// from each end of the second.
fn closest(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> [(Vec2, Vec2); 4] {
    [(a, nearest(a, c, d)), (b, nearest(b, c, d)), (nearest(c, a, b), c), (nearest(d, a, b), d)]
}

/// Returns whether two lines cross in their insides.
fn crosses(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool {
    let side = |p: Vec2, q: Vec2, r: Vec2| cross(q - p, r - p);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

fn crossing(a: Vec2, b: Vec2, e: &SolidEdge) -> Vec2 {
    let (d, g) = (b - a, e.to - e.from);
    a + d * (cross(e.from - a, g) / cross(d, g))
}

/// Distance of two lines, m; 0 where they cross.
pub(super) fn distance(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> f64 {
    if crosses(a, b, c, d) {
        return 0.0;
    }
    closest(a, b, c, d).into_iter().map(|(p, q)| (p - q).norm()).fold(f64::INFINITY, f64::min)
}

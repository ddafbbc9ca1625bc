//! A case is drawn by a family: a scene, the model that is asked, and what is known of the answer.

use cable_core::scene::{Cable, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::{Load, Model};

pub type Point = [f64; 2];

/// The verdict that must come out.
#[derive(Clone, Debug, PartialEq)]
pub enum Expect {
    /// There is a resting place.
    Rests,
    /// There is one, and these are the forces of the cable on its first and last support, N, within
    /// this part of the greatest.
    Forces([Point; 2], f64),
    /// Nothing holds it.
    Slides,
    /// The scene may be refused in words: a support lies in something solid, say.
    Perhaps,
}

/// A scene with its question.
#[derive(Clone, Debug)]
pub struct Case {
    pub scene: Scene,
    pub model: Model,
    pub expect: Expect,
}

impl Case {
    pub fn new(scene: Scene, expect: Expect) -> Self {
        Self { scene, model: Model::Auto, expect }
    }

    pub fn rests(scene: Scene) -> Self {
        Self::new(scene, Expect::Rests)
    }
}

/// A flexible cable alone: length (m), density (kg/m), EA (N), diameter (m).
pub fn cable([length, density, ea, diameter]: [f64; 4], supports: Vec<Support>) -> Scene {
    let mut scene = catalog::cable_alone([length, density, ea], supports);
    let c = &mut scene.cables[0];
    (c.preset, c.name, c.diameter_m, c.segments) = (None, "c".to_owned(), diameter, None);
    (c.min_bend_radius_m, c.friction, c.sidewall_limit_n_per_m) = (0.0, 0.0, None);
    scene.obstacles.clear();
    scene.name = "campaign".to_owned();
    scene
}

pub fn fixed(at: [Point; 2]) -> Vec<Support> {
    vec![Support::fixed("a", at[0]), Support::fixed("b", at[1])]
}

pub fn load_end(name: &str, force: Point) -> Support {
    Support { force_n: Some(force), ..Support::new(name, SupportKind::Load) }
}

pub fn clamp(name: &str, at: Point, angle_deg: f64) -> Support {
    Support { at_m: Some(at), angle_deg: Some(angle_deg), ..Support::new(name, SupportKind::Clamped) }
}

pub fn wheel(name: &str, at: Point, radius: f64, friction: f64) -> Support {
    Support { radius_m: Some(radius), friction: Some(friction), ..Support::pulley(name, at) }
}

pub fn load(arc_length_m: f64, force: Point) -> Load {
    Load { cable: "c".to_owned(), arc_length_m, force_n: Some(force), times_s: Vec::new(), forces_n: Vec::new() }
}

impl Case {
    pub fn cable(&mut self) -> &mut Cable {
        &mut self.scene.cables[0]
    }
}

/// Puts an obstacle into a scene.
pub fn put(scene: &mut Scene, shape: Shape, friction: f64) {
    let name = format!("o{}", scene.obstacles.len());
    scene.obstacles.push(Obstacle { name, shape, friction: Some(friction) });
}

pub fn terrain(points_m: Vec<Point>) -> Shape {
    Shape::Terrain { points_m }
}

/// Flat ground at a height from one place to another.
pub fn flat(height: f64, [from, to]: [f64; 2]) -> Shape {
    terrain(vec![[from, height], [to, height]])
}

/// A box from its lower left corner.
pub fn block([x, y]: Point, [w, h]: [f64; 2]) -> Shape {
    Shape::Polygon { points_m: vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]] }
}

pub fn post(center_m: Point, radius_m: f64) -> Shape {
    Shape::Circle { center_m, radius_m }
}

pub fn apart(p: Point, q: Point) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

pub fn way(points: &[Point]) -> f64 {
    points.windows(2).map(|w| apart(w[0], w[1])).sum()
}

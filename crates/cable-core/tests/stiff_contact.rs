//! These tests compare stiff cables on posts, corners and floors with the elastica by multiple
//! shooting, which shares nothing with the program: its own Runge–Kutta steps, its own geometry,
//! dense Newton with differences. Scenes are drawn at random.
//!
//! A guess is read off the answer, and with it which contacts are a point; the shooting then finds
//! the root of its own equations near it, and it is asked that its contacts push. That the root is
//! the only one, that a point contact is less bent than its round and that nothing lies inside is
//! not asked here.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use cable_core::scene::Scene;
use cable_core::solution::{CableSolution, ContactReport};
use cable_core::{Model, Settings, Simulation};
use dice::MmixDice;
use nalgebra::{DMatrix, DVector, Vector2};

type V = Vector2<f64>;

/// An obstacle of a scene as the shooting sees it: rounds of the centre line, and lines.
#[derive(Clone, Copy, Debug)]
enum Shape {
    Round { center: V, radius: f64 },
    Line { at: V, normal: V },
}

impl Shape {
    fn gap(&self, x: V) -> (f64, V) {
        match *self {
            Self::Round { center, radius } => ((x - center).norm() - radius, (x - center).normalize()),
            Self::Line { at, normal } => ((x - at).dot(&normal), normal),
        }
    }

    fn bend(&self) -> f64 {
        match *self {
            Self::Round { radius, .. } => 1.0 / radius,
            Self::Line { .. } => 0.0,
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Tip {
    Pinned(V),
    Clamped(V, f64),
    Loaded(V),
}

#[derive(Clone, Debug)]
struct Case {
    name: String,
    text: String,
    ei: f64,
    ea: f64,
    weight: f64,
    length: f64,
    tips: [Tip; 2],
    shapes: Vec<Shape>,
    /// The place of a load, and its force.
    load: Option<(f64, V)>,
    friction: f64,
}

/// A contact of the shooting.
#[derive(Clone, Copy, Debug)]
struct Mark {
    shape: Shape,
    stretch: bool,
    sense: f64,
    friction: f64,
    /// First guesses: where it begins and ends, and the forces there.
    s: [f64; 2],
    push: [f64; 2],
}

/// x, y, angle, moment, force (2).
type State = [f64; 6];

fn perp(v: V) -> V {
    V::new(-v.y, v.x)
}

fn unit(a: f64) -> V {
    V::new(a.cos(), a.sin())
}

/// Places along the cable where something happens.
#[derive(Clone, Copy, Debug)]
enum Event {
    Contact(usize),
    Load(f64, V),
}

struct Shooting<'a> {
    case: &'a Case,
    marks: Vec<Mark>,
    events: Vec<Event>,
    /// Steps of each piece that is shot.
    steps: usize,
    /// Pieces that the cable between two events is cut into.
    cuts: Vec<usize>,
    /// True if the cable ends on its last contact.
    lies: bool,
}

impl Shooting<'_> {
    fn slope(&self, u: &State) -> State {
        let (t, f) = (unit(u[2]), V::new(u[4], u[5]));
        let stretched = 1.0 + f.dot(&t) / self.case.ea;
        [stretched * t.x, stretched * t.y, u[3] / self.case.ei, -stretched * f.dot(&perp(t)), 0.0, self.case.weight]
    }

    /// Kutta's steps of fourth order.
    fn shoot(&self, mut u: State, from: f64, to: f64) -> State {
        let h = (to - from) / self.steps as f64;
        for _ in 0..self.steps {
            let add = |k: &State, c: f64| -> State { std::array::from_fn(|i| u[i] + c * k[i]) };
            let a = self.slope(&u);
            let b = self.slope(&add(&a, 0.5 * h));
            let c = self.slope(&add(&b, 0.5 * h));
            let d = self.slope(&add(&c, h));
            u = std::array::from_fn(|i| u[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        u
    }

    /// Tension and angle at the end of a stretch of contact, and the normal force on it.
    fn slide(&self, mark: &Mark, mut tension: f64, mut angle: f64, length: f64) -> [f64; 3] {
        let (h, b) = (length / self.steps as f64, V::new(0.0, -self.case.weight));
        let mut pressed = 0.0;
        let slope = |u: [f64; 2]| {
            let t = unit(u[1]);
            let turn = mark.sense * mark.shape.bend() * (1.0 + u[0] / self.case.ea);
            // Balance across: T θ' n + b + p N = 0 with N = −σ n.
            let p = mark.sense * (u[0] * turn + b.dot(&perp(t)));
            [-b.dot(&t) - mark.friction * p, turn, p]
        };
        for _ in 0..self.steps {
            let u = [tension, angle];
            let add = |k: [f64; 3], c: f64| [u[0] + c * k[0], u[1] + c * k[1]];
            let a = slope(u);
            let b = slope(add(a, 0.5 * h));
            let c = slope(add(b, 0.5 * h));
            let d = slope(add(c, h));
            let sum: [f64; 3] = std::array::from_fn(|i| h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
            (tension, angle, pressed) = (tension + sum[0], angle + sum[1], pressed + sum[2]);
        }
        [tension, angle, pressed]
    }

    /// All that has to be zero, and what the root says: the forces at both ends, the normal force
    /// of each contact.
    fn residual(&self, y: &[f64]) -> (Vec<f64>, Vec<V>, Vec<f64>) {
        let (case, mut k) = (self.case, 0);
        let mut take = |n: usize| {
            k += n;
            &y[k - n..k]
        };
        let (mut out, mut forces, mut normals) = (Vec::new(), Vec::new(), Vec::new());
        let (mut s, mut u): (f64, Option<State>) = (0.0, None);
        for (i, event) in self.events.iter().map(Some).chain([None]).enumerate() {
            if i == self.events.len() && self.lies {
                break;
            }
            // The quantity that the event needs, before the way to it.
            let marked: Vec<f64> = match event {
                Some(Event::Contact(m)) if self.marks[*m].stretch => {
                    take(if self.lies && *m + 1 == self.marks.len() { 2 } else { 4 }).to_vec()
                }
                Some(Event::Contact(_)) => take(2).to_vec(),
                _ => Vec::new(),
            };
            let to = match event {
                Some(Event::Contact(_)) => marked[0],
                Some(Event::Load(s, _)) => *s,
                None => case.length,
            };
            for c in 0..self.cuts[i] {
                let start: State = std::array::from_fn({
                    let v = take(6).to_vec();
                    move |j| v[j]
                });
                match u {
                    None => {
                        forces.push(V::new(start[4], start[5]));
                        self.tip(0, &start, &mut out);
                    }
                    Some(u) => out.extend((0..6).map(|j| start[j] - u[j])),
                }
                let part = |c: usize| s + (to - s) * c as f64 / self.cuts[i] as f64;
                u = Some(self.shoot(start, part(c), part(c + 1)));
            }
            s = to;
            let mut here = u.unwrap();
            match event {
                Some(Event::Load(_, f)) => {
                    here[4] -= f.x;
                    here[5] -= f.y;
                }
                Some(Event::Contact(m)) => {
                    let mark = &self.marks[*m];
                    let (gap, normal) = mark.shape.gap(V::new(here[0], here[1]));
                    let t = unit(here[2]);
                    out.extend([gap, normal.dot(&t)]);
                    let push = |here: &mut State, p: f64| {
                        let f = (normal_of(mark, here) + unit(here[2]) * mark.friction) * p;
                        here[4] -= f.x;
                        here[5] -= f.y;
                    };
                    push(&mut here, marked[1]);
                    let mut pressed = marked[1];
                    if mark.stretch {
                        let pull = V::new(here[4], here[5]).dot(&t);
                        let bent = case.ei * mark.sense * mark.shape.bend();
                        out.extend([here[3] - bent * (1.0 + pull / case.ea), V::new(here[4], here[5]).dot(&perp(t))]);
                        let end = if marked.len() > 2 { marked[2] } else { case.length };
                        let [pull, angle, on] = self.slide(mark, pull, here[2], end - s);
                        let way = (end - s) * (1.0 + pull / case.ea);
                        let x = match mark.shape {
                            Shape::Round { center, radius } => center - perp(unit(angle)) * (mark.sense * radius),
                            Shape::Line { .. } => V::new(here[0], here[1]) + t * way,
                        };
                        let f = unit(angle) * pull;
                        here = [x.x, x.y, angle, bent * (1.0 + pull / case.ea), f.x, f.y];
                        pressed += on;
                        if marked.len() > 2 {
                            push(&mut here, marked[3]);
                            pressed += marked[3];
                        } else {
                            let Tip::Loaded(load) = case.tips[1] else { panic!("an end that lies is pulled") };
                            out.push(pull - load.dot(&unit(angle)));
                        }
                        s = end;
                    }
                    normals.push(pressed);
                }
                None => self.tip(1, &here, &mut out),
            }
            u = Some(here);
        }
        let u = u.unwrap();
        forces.push(V::new(u[4], u[5]));
        assert_eq!((k, out.len()), (y.len(), y.len()), "{}", case.name);
        (out, forces, normals)
    }

    fn tip(&self, which: usize, u: &State, out: &mut Vec<f64>) {
        let (x, f) = (V::new(u[0], u[1]), V::new(u[4], u[5]));
        let sign = if which == 0 { -1.0 } else { 1.0 };
        let (a, last) = match self.case.tips[which] {
            Tip::Pinned(p) => (x - p, u[3]),
            Tip::Clamped(p, angle) => (x - p, u[2] - angle),
            Tip::Loaded(load) => (f - load * sign, u[3]),
        };
        out.extend([a.x, a.y, last]);
    }

    #[allow(clippy::type_complexity)]
    fn newton(&self, mut y: Vec<f64>) -> Result<(Vec<V>, Vec<f64>, Vec<f64>), String> {
        let n = y.len();
        let sizes: Vec<f64> = y.iter().map(|v| 1e-7 * (v.abs() + 1e-2)).collect();
        let mut step_before = f64::INFINITY;
        for _ in 0..40 {
            let (r, forces, normals) = self.residual(&y);
            let mut jacobian = DMatrix::zeros(n, n);
            for j in 0..n {
                let keep = y[j];
                y[j] = keep + sizes[j];
                let high = self.residual(&y).0;
                y[j] = keep - sizes[j];
                let low = self.residual(&y).0;
                y[j] = keep;
                for i in 0..n {
                    jacobian[(i, j)] = (high[i] - low[i]) / (2.0 * sizes[j]);
                }
            }
            let Some(step) = jacobian.lu().solve(&-DVector::from_vec(r)) else { return Err("singular".to_owned()) };
            let size = step.iter().zip(&y).map(|(d, v)| d.abs() / (v.abs() + 1.0)).fold(0.0, f64::max);
            let part = (0.5 / size).min(1.0);
            for (v, d) in y.iter_mut().zip(step.iter()) {
                *v += part * d;
            }
            if size < 1e-12 || (size < 1e-9 && size > 0.3 * step_before) {
                return Ok((forces, normals, y));
            }
            step_before = size;
        }
        Err(format!("no root, last step {step_before:.1e}"))
    }
}

fn normal_of(mark: &Mark, u: &State) -> V {
    perp(unit(u[2])) * -mark.sense
}

/// Place, direction and curvature at an arc length (m); directions run on from chord to chord.
fn at(cable: &CableSolution, s: f64) -> (V, f64, f64) {
    let n = &cable.nodes;
    let k = n.partition_point(|p| p.arc_length_m <= s).clamp(1, n.len() - 1);
    let (a, b) = (&n[k - 1], &n[k]);
    let l = b.arc_length_m - a.arc_length_m;
    let f = (s - a.arc_length_m) / l;
    let d = b.at() - a.at();
    // From the middle of the chord to s the cable turns by what its curvature says.
    let (p, q) = (a.curvature_per_m, b.curvature_per_m);
    let turn = l * (p * (f - 0.5) + (q - p) * (0.5 * f * f - 1.0 / 6.0));
    let bulge = perp(d) * (-0.5 * f * (1.0 - f) * l * 0.5 * (p + q));
    (a.at() + d * f + bulge, d.y.atan2(d.x) + turn, p + (q - p) * f)
}

/// The root near an answer, with `steps` of each shot.
fn root(case: &Case, cable: &CableSolution, steps: usize) -> Result<(Vec<V>, Vec<f64>), String> {
    let mut marks = Vec::new();
    let mut events: Vec<(f64, Event)> = Vec::new();
    let first = V::new(cable.supports[0].reaction_x_n, cable.supports[0].reaction_y_n);
    for (k, c) in cable.contacts.iter().enumerate() {
        let (x, angle, _) = at(cable, c.arc_length_m);
        let shape = *case.shapes.iter().min_by(|a, b| a.gap(x).0.abs().total_cmp(&b.gap(x).0.abs())).unwrap();
        let sense = if shape.gap(x).1.dot(&perp(unit(angle))) > 0.0 { -1.0 } else { 1.0 };
        let friction = if c.normal_n > 0.0 { c.friction_n / c.normal_n } else { 0.0 };
        if friction.abs() > case.friction * (1.0 + 1e-9) {
            return Err(format!("friction of {friction} where {} is all", case.friction));
        }
        let stretch = c.ends_m > c.begins_m;
        let ends = if stretch { [0.1, 0.1] } else { [1.0, 0.0] };
        marks.push(Mark {
            shape,
            stretch,
            sense,
            friction,
            s: [c.begins_m, c.ends_m],
            push: ends.map(|e| e * c.normal_n),
        });
        events.push((c.begins_m, Event::Contact(k)));
    }
    events.extend(case.load.map(|(s, f)| (s, Event::Load(s, f))));
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let lies = marks.last().is_some_and(|m: &Mark| m.s[1] >= case.length * (1.0 - 1e-9));
    let events: Vec<Event> = events.into_iter().map(|e| e.1).collect();
    let mut shooting = Shooting { case, marks, events, steps, cuts: Vec::new(), lies };
    // The guess, and how often each way is cut: e^{3} is the most that a shot grows by.
    let (mut y, mut s, mut carried) = (Vec::new(), 0.0, V::zeros());
    let mut last_angle: Option<f64> = None;
    let most = cable.nodes.iter().map(|n| n.tension_n.abs()).fold(0.0, f64::max);
    for i in 0..=shooting.events.len() {
        if i == shooting.events.len() && lies {
            break;
        }
        let (to, beyond) = match shooting.events.get(i) {
            Some(Event::Contact(m)) => {
                let mark = shooting.marks[*m];
                y.extend([mark.s[0], mark.push[0]]);
                let ends = lies && *m + 1 == shooting.marks.len();
                if mark.stretch && !ends {
                    y.extend([mark.s[1], mark.push[1]]);
                }
                (mark.s[0], mark.s[1])
            }
            Some(Event::Load(s, _)) => (*s, *s),
            None => (case.length, case.length),
        };
        let cuts = ((to - s) / (3.0 * (case.ei / most).sqrt())).ceil().clamp(2.0, 50.0) as usize;
        shooting.cuts.push(cuts);
        for c in 0..cuts {
            let here = s + (to - s) * c as f64 / cuts as f64;
            let (x, raw, curvature) = at(cable, here + 1e-9);
            let tau = std::f64::consts::TAU;
            let angle = last_angle.map_or(raw, |l: f64| raw + ((l - raw) / tau).round() * tau);
            last_angle = Some(angle);
            let f = first + V::new(0.0, case.weight * here) - carried;
            y.extend([x.x, x.y, angle, curvature * case.ei, f.x, f.y]);
        }
        match shooting.events.get(i) {
            Some(Event::Contact(m)) => {
                let c: &ContactReport = &cable.contacts[*m];
                carried += V::new(c.force_n[0], c.force_n[1]);
            }
            Some(Event::Load(_, f)) => carried += f,
            None => {}
        }
        s = beyond;
    }
    let (forces, normals, y) = shooting.newton(y)?;
    // The condition under which the root is a resting place.
    let mut k = 0;
    for (i, event) in shooting.events.iter().enumerate() {
        if let Event::Contact(m) = event {
            let mark = &shooting.marks[*m];
            let ends = lies && *m + 1 == shooting.marks.len();
            let count = if mark.stretch && !ends { 4 } else { 2 };
            let marked = &y[k..k + count];
            k += count;
            let scale = 1e-6 * most;
            if marked[1] < -scale || (count == 4 && (marked[3] < -scale || marked[2] < marked[0])) {
                return Err(format!("contact {m} pulls: {marked:?}"));
            }
            k += 6 * shooting.cuts[i];
            if !mark.stretch {
                let start = &y[k - 6..k];
                let before = if shooting.cuts[i] > 0 { marked[0] } else { 0.0 };
                let _ = (start, before);
            }
        } else {
            k += 6 * shooting.cuts[i];
        }
    }
    Ok((forces, normals))
}

fn cable_text(length: f64, ei: f64, ea: f64, w: f64, friction: f64, diameter: f64) -> String {
    format!(
        "version = 1\nname = \"stiff\"\n[environment]\ngravity_m_per_s2 = 10.0\n[[cables]]\nname = \"c\"\nlength_m = {length:?}\n\
         linear_density_kg_per_m = {:?}\naxial_stiffness_n = {ea:?}\nbending_stiffness_n_m2 = {ei:?}\ndiameter_m = {diameter:?}\n\
         service_tension_n = 1e14\nbreaking_tension_n = 1e14\nfriction = {friction:?}\n",
        w / 10.0
    )
}

/// A cable from a held or clamped end over a post to a dead load or a second held end.
fn over_a_post(r: &mut MmixDice, k: usize) -> Case {
    let (radius, diameter) = (r.log(0.05, 1.0), 0.01);
    let center_radius = radius + 0.5 * diameter;
    let pull = r.log(20.0, 500.0);
    // Shorter layers are more than shots can cross: see the closed form below.
    let ei = pull * r.log(0.08, 0.6).powi(2);
    let friction = if k % 3 == 2 { r.within(0.05, 0.5) } else { 0.0 };
    let (left, right) = (r.within(20.0, 80.0f64).to_radians(), r.within(20.0, 80.0f64).to_radians());
    let spans = [r.within(1.5, 3.0), r.within(1.5, 3.0)];
    let round = |a: f64| V::new(a.sin(), a.cos()) * center_radius;
    let a = round(-left) - V::new(left.cos(), left.sin()) * spans[0];
    let b = round(right) + V::new(right.cos(), -right.sin()) * spans[1];
    let w = if k.is_multiple_of(4) { 1e-5 } else { pull * r.log(1e-3, 0.1) };
    let way = spans[0] + center_radius * (left + right) + spans[1];
    let ea = 1e6;
    // Held at both ends its tension comes of its stretch.
    let length = if k.is_multiple_of(2) { way } else { way * (1.0 - pull / ea) };
    let clamp = k % 5 == 4;
    let angle = left.to_degrees() + r.within(-20.0, 20.0);
    let mut text = cable_text(length, ei, ea, w, friction, diameter);
    let turns = (0..=8).map(|i| round(-left + (left + right) * f64::from(i) / 8.0) * 1.05);
    let route: Vec<String> =
        [a].into_iter().chain(turns).chain([b]).map(|p| format!("[{:?}, {:?}]", p.x, p.y)).collect();
    text += &format!("route_m = [{}]\n", route.join(", "));
    text += &if clamp {
        format!(
            "[[cables.supports]]\nname = \"A\"\nkind = \"clamped\"\nat_m = [{:?}, {:?}]\nangle_deg = {angle:?}\n",
            a.x, a.y
        )
    } else {
        format!("[[cables.supports]]\nname = \"A\"\nkind = \"fixed\"\nat_m = [{:?}, {:?}]\n", a.x, a.y)
    };
    let force = V::new(right.cos(), -right.sin()) * pull;
    let held = k % 2 == 1;
    let b_tip = if held {
        text += &format!("[[cables.supports]]\nname = \"B\"\nkind = \"fixed\"\nat_m = [{:?}, {:?}]\n", b.x, b.y);
        Tip::Pinned(b)
    } else {
        text +=
            &format!("[[cables.supports]]\nname = \"B\"\nkind = \"load\"\nforce_n = [{:?}, {:?}]\n", force.x, force.y);
        Tip::Loaded(force)
    };
    text += &format!(
        "[[obstacles]]\nname = \"post\"\nkind = \"circle\"\ncenter_m = [0.0, 0.0]\nradius_m = {radius:?}\nfriction = {friction:?}\n"
    );
    Case {
        name: format!("post {k}"),
        text,
        ei,
        ea,
        weight: w,
        length,
        tips: [if clamp { Tip::Clamped(a, angle.to_radians()) } else { Tip::Pinned(a) }, b_tip],
        shapes: vec![Shape::Round { center: V::zeros(), radius: center_radius }],
        load: None,
        friction,
    }
}

/// A cable over the edge of a table, or over both edges of a box.
fn over_corners(r: &mut MmixDice, k: usize) -> Case {
    let diameter = r.log(0.005, 0.05);
    let pull = r.log(20.0, 500.0);
    let ei = pull * r.log(0.08, 0.5).powi(2);
    let friction = if k % 3 == 2 { r.within(0.05, 0.4) } else { 0.0 };
    let width = r.within(0.8, 2.0);
    let (left, right) = (r.within(15.0, 60.0f64).to_radians(), r.within(20.0, 75.0f64).to_radians());
    let corners = [V::new(-0.5 * width, 0.0), V::new(0.5 * width, 0.0)];
    let spans = [r.within(1.5, 3.0), r.within(1.5, 3.0)];
    let a = corners[0] + V::new(-left.cos(), -left.sin()) * spans[0] + V::new(0.0, diameter);
    let force = V::new(right.cos(), -right.sin()) * pull;
    let w = if k.is_multiple_of(4) { 1e-5 } else { pull * r.log(1e-3, 0.1) };
    let b = corners[1] + force / pull * spans[1];
    let lift = V::new(0.0, 2.0 * diameter);
    let length = spans[0] + width + spans[1];
    let clamp = k % 5 == 3;
    let angle = left.to_degrees() + r.within(-15.0, 15.0);
    let mut text = cable_text(length, ei, 1e6, w, friction, diameter);
    let route: Vec<String> =
        [a, corners[0] + lift, corners[1] + lift, b].iter().map(|p| format!("[{:?}, {:?}]", p.x, p.y)).collect();
    text += &format!("route_m = [{}]\n", route.join(", "));
    text += &if clamp {
        format!(
            "[[cables.supports]]\nname = \"A\"\nkind = \"clamped\"\nat_m = [{:?}, {:?}]\nangle_deg = {angle:?}\n",
            a.x, a.y
        )
    } else {
        format!("[[cables.supports]]\nname = \"A\"\nkind = \"fixed\"\nat_m = [{:?}, {:?}]\n", a.x, a.y)
    };
    text += &format!("[[cables.supports]]\nname = \"B\"\nkind = \"load\"\nforce_n = [{:?}, {:?}]\n", force.x, force.y);
    let deep = 3.0 + spans[0].max(spans[1]);
    let points = [corners[0] - V::new(0.0, deep), corners[1] - V::new(0.0, deep), corners[1], corners[0]];
    let points: Vec<String> = points.iter().map(|p| format!("[{:?}, {:?}]", p.x, p.y)).collect();
    text += &format!(
        "[[obstacles]]\nname = \"box\"\nkind = \"polygon\"\npoints_m = [{}]\nfriction = {friction:?}\n",
        points.join(", ")
    );
    let off = 0.5 * diameter;
    let mut shapes: Vec<Shape> = corners.iter().map(|&center| Shape::Round { center, radius: off }).collect();
    shapes.push(Shape::Line { at: V::new(0.0, off), normal: V::y() });
    let start = if clamp { Tip::Clamped(a, angle.to_radians()) } else { Tip::Pinned(a) };
    Case {
        name: format!("corners {k}"),
        text,
        ei,
        ea: 1e6,
        weight: w,
        length,
        tips: [start, Tip::Loaded(force)],
        shapes,
        load: None,
        friction,
    }
}

/// A heavy cable from a height down to a floor, along which its end is pulled.
fn to_a_floor(r: &mut MmixDice, k: usize) -> Case {
    let (w, diameter, height) = (r.log(2.0, 30.0), r.log(0.01, 0.05), r.within(1.0, 4.0));
    let pull = w * height * r.log(0.2, 3.0);
    let ei = w * r.log(0.4, 2.0f64).powi(3);
    let friction = if k % 3 == 2 { r.within(0.05, 0.5) } else { 0.0 };
    let length = 3.0 * height + 2.5 * pull / w;
    let a = V::new(0.0, height);
    let clamp = k % 2 == 1;
    let angle = r.within(-80.0, -10.0);
    let mut text = cable_text(length, ei, 1e6, w, friction, diameter);
    text += &if clamp {
        format!(
            "[[cables.supports]]\nname = \"A\"\nkind = \"clamped\"\nat_m = [{:?}, {:?}]\nangle_deg = {angle:?}\n",
            a.x, a.y
        )
    } else {
        format!("[[cables.supports]]\nname = \"A\"\nkind = \"fixed\"\nat_m = [{:?}, {:?}]\n", a.x, a.y)
    };
    text += &format!("[[cables.supports]]\nname = \"B\"\nkind = \"load\"\nforce_n = [{pull:?}, 0.0]\n");
    let lay = format!(
        "route_m = [[0.0, {height:?}], [{:?}, {diameter:?}], [{:?}, {diameter:?}]]\nfriction =",
        0.7 * height,
        length - 0.3 * height
    );
    text = text.replacen("friction =", &lay, 1);
    text += &format!(
        "[[obstacles]]\nname = \"floor\"\nkind = \"terrain\"\npoints_m = [[-50.0, 0.0], [200.0, 0.0]]\nfriction = {friction:?}\n"
    );
    let start = if clamp { Tip::Clamped(a, angle.to_radians()) } else { Tip::Pinned(a) };
    Case {
        name: format!("floor {k}"),
        text,
        ei,
        ea: 1e6,
        weight: w,
        length,
        tips: [start, Tip::Loaded(V::new(pull, 0.0))],
        shapes: vec![Shape::Line { at: V::new(0.0, 0.5 * diameter), normal: V::y() }],
        load: None,
        friction,
    }
}

fn solve(case: &Case) -> Result<CableSolution, String> {
    let scene = Scene::from_toml(&case.text).map_err(|e| e.to_string())?;
    let mut simulation =
        Simulation::with_settings(scene, Model::Fem, Settings::default()).map_err(|e| e.to_string())?;
    simulation.settle().map_err(|e| e.to_string())?;
    Ok(simulation.solution().cables.remove(0))
}

/// The worst of the forces at both ends and of the contacts, in parts of the greatest; what is said
/// of it.
fn error(case: &Case) -> Result<(f64, f64), String> {
    let cable = solve(case)?;
    let Some(said) = cable.error_estimate else { return Err("no estimate".to_owned()) };
    if cable.contacts.is_empty() {
        return Err("no contact".to_owned());
    }
    let (forces, normals) = root(case, &cable, 40)?;
    let found = [0, 1].map(|k| {
        let s = &cable.supports[k];
        V::new(s.reaction_x_n, s.reaction_y_n) * if k == 0 { 1.0 } else { -1.0 }
    });
    let mut most: f64 = 0.0;
    let mut off: f64 = 0.0;
    for (a, b) in found.iter().zip(&forces) {
        most = most.max(b.norm());
        off = off.max((a - b).norm());
    }
    for (c, n) in cable.contacts.iter().zip(&normals) {
        most = most.max(n.abs());
        off = off.max((c.normal_n - n).abs());
    }
    Ok((off / most, said))
}

fn campaign(seed: u64, count: usize, draw: impl Fn(&mut MmixDice, usize) -> Case) {
    let mut r = MmixDice(seed);
    let (mut right, mut bad, mut missed) = (0, Vec::new(), Vec::new());
    for k in 0..count {
        let case = draw(&mut r, k);
        match error(&case) {
            Ok((off, said)) if off <= 3.0 * said + 1e-7 => right += 1,
            Ok((off, said)) => bad.push(format!("{}: off by {off:.1e}, says {said:.1e}", case.name)),
            // The shooting's fault: its guess is too rough where a cable is held at both ends.
            Err(e) if e.starts_with("no root") => missed.push(format!("{}: {e}", case.name)),
            Err(e) => bad.push(format!("{}: {e}", case.name)),
        }
    }
    println!("{right} of {count}\n{}", bad.join("\n"));
    println!("{}", missed.join("\n"));
    assert!(10 * right >= 7 * count, "{right} of {count} compared");
    assert!(bad.is_empty(), "{right} of {count} right\n{}", bad.join("\n"));
}

#[test]
fn posts_are_right() {
    campaign(1, 30, over_a_post);
}

#[test]
fn corners_are_right() {
    campaign(2, 30, over_corners);
}

#[test]
fn floors_are_right() {
    campaign(3, 30, to_a_floor);
}

/// Weightless and straight far from a frictionless round, T + M²/2EI is the same all along: in
/// contact the tension is T − EI/2ρ², the cable lies on what its layers leave of the turn, θ − 2
/// acos(1 − EI/2Tρ²), and touches in a point where that is nothing; there 1 − cos ½θ = M²/2EIT.
#[test]
fn a_weightless_cable_over_a_post_keeps_its_first_integral() {
    let (radius, turn, pull) = (0.5f64, 1.6f64, 100.0f64);
    let limit = 2.0 * pull * radius * radius * (1.0 - (0.5 * turn).cos());
    for part in [1e-4, 1e-3, 1e-2, 0.1, 0.5, 0.9, 1.1, 2.0] {
        let ei = part * limit;
        let layer = (ei / pull).sqrt();
        let span = 25.0 * layer + 1.0;
        let (n, t) = (V::new(-(0.5 * turn).sin(), (0.5 * turn).cos()), V::new((0.5 * turn).cos(), (0.5 * turn).sin()));
        let a = n * radius - t * span;
        let length = 2.0 * span + radius * turn;
        let mut text = cable_text(length, ei, 1e9, 1e-5, 0.0, 0.01);
        let round = |i: i32| {
            let angle = turn * (f64::from(i) / 8.0 - 0.5);
            V::new(angle.sin(), angle.cos()) * (1.05 * radius)
        };
        let b = V::new(-a.x, a.y);
        let route: Vec<String> =
            [a].into_iter().chain((0..=8).map(round)).chain([b]).map(|p| format!("[{:?}, {:?}]", p.x, p.y)).collect();
        text += &format!("route_m = [{}]\n", route.join(", "));
        text += &format!("[[cables.supports]]\nname = \"A\"\nkind = \"fixed\"\nat_m = [{:?}, {:?}]\n", a.x, a.y);
        text += &format!(
            "[[cables.supports]]\nname = \"B\"\nkind = \"load\"\nforce_n = [{:?}, {:?}]\n",
            pull * t.x,
            -pull * t.y
        );
        text += &format!(
            "[[obstacles]]\nname = \"post\"\nkind = \"circle\"\ncenter_m = [0.0, 0.0]\nradius_m = {:?}\n",
            radius - 0.005
        );
        let scene = Scene::from_toml(&text).unwrap();
        let mut simulation = Simulation::with_settings(scene, Model::Fem, Settings::default()).unwrap();
        simulation.settle().unwrap();
        let cable = simulation.solution().cables.remove(0);
        let contact = &cable.contacts[0];
        let loss = ei / (2.0 * radius * radius);
        let (_, _, bend) = at(&cable, contact.arc_length_m);
        println!("{part}: {contact:?}");
        if part < 1.0 {
            // The direction of the cable at A is not that of the load exactly: A's end is where the
            // flexible cable would be.
            let tension = cable.nodes[cable.nodes.len() / 2].tension_n;
            let lies = contact.turn_deg.to_radians().abs();
            assert!(
                (contact.tension_after_n - (pull - loss)).abs() < 1e-4 * pull,
                "{part}: {} N",
                contact.tension_after_n
            );
            // A stiffness that takes less than the tolerance of the tension is neglected: the cable
            // lies on all of the turn, as a flexible one does.
            let flexible = 2.0 * loss < Settings::default().tolerance * pull;
            assert!(tension > 0.0 && lies < if flexible { turn + 1e-6 } else { turn }, "{part}: {lies}");
        } else {
            assert_eq!(contact.begins_m, contact.ends_m, "{part}");
            let tension = contact.tension_after_n + 0.5 * ei * bend * bend;
            assert!((tension - pull).abs() < 1e-3 * pull, "{part}: {tension} N");
        }
    }
}

#[test]
fn what_a_sliding_node_leaves_out_of_a_stiff_bend_is_said_in_every_step() {
    // Over a small post the cable bends as an elastica would, not as a string: a sliding node there
    // carries no moment.
    let scene = |stiffness: f64| {
        let text = format!(
            r#"
            version = 1
            [[cables]]
            name = "c"
            length_m = 6.1
            linear_density_kg_per_m = 0.5
            axial_stiffness_n = 1e6
            bending_stiffness_n_m2 = {stiffness}
            service_tension_n = 1e4
            breaking_tension_n = 1e5
            min_bend_radius_m = 0.01
            diameter_m = 0.02
            friction = 0.2
            supports = [
                {{ name = "a", kind = "fixed", at_m = [0.0, 0.0] }},
                {{ name = "b", kind = "fixed", at_m = [6.0, 0.0], motion = {{ times_s = [0.0, 2.0], points_m = [[6.0, 0.0], [6.05, 0.0]] }} }},
            ]
            [[obstacles]]
            name = "post"
            kind = "circle"
            center_m = [3.0, -0.1]
            radius_m = 0.05
            "#
        );
        Scene::from_toml(&text).unwrap()
    };
    let step = |stiffness: f64, segments: Option<usize>| {
        let mut scene = scene(stiffness);
        scene.cables[0].segments = segments;
        let mut simulation = Simulation::new(scene, Model::Fem).unwrap();
        simulation.settle().unwrap();
        simulation.step_quasi_static(0.1).unwrap();
        simulation.solution()
    };
    let said = |answer: &cable_core::Solution| {
        answer
            .warnings
            .iter()
            .any(|w| w.kind == cable_core::solution::WarningKind::Accuracy && w.to_string().contains("bend"))
    };
    let (stiff, flexible, open) = (step(2.0, Some(60)), step(0.0, Some(60)), step(2.0, None));
    let estimate = stiff.cables[0].error_estimate;
    assert!(said(&stiff) && estimate.is_some_and(|e| e > 1e-3), "{estimate:?} {:?}", stiff.warnings);
    assert!(!said(&flexible), "{:?}", flexible.warnings);
    // A mesh that may be refined is, and leaves nothing of that out.
    let estimate = open.cables[0].error_estimate;
    assert!(!said(&open) && estimate.is_some_and(|e| e <= 1e-3), "{estimate:?} {:?}", open.warnings);
}

/// A free piece of one element between two contacts ran into the crest between its nodes, and was
/// to be parted at a node that it does not have: a panic.
#[test]
fn issue_015_a_piece_of_one_element_has_no_node_to_part_at() {
    let scene = Scene::from_toml(include_str!("data/rounded_crest.toml")).expect("a sound scene");
    for model in [Model::Spans, Model::Auto, Model::Fem] {
        Simulation::new(scene.clone(), model).expect("a model").settle().expect("a rest");
    }
}

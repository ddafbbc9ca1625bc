//! Which contacts will slide in a step, before it is solved.
//!
//! Newton's method with a wrong set of sliding contacts ends at a state that shows the next wrong set: of ten contacts in a
//! row one after the other is found to slide. To first order the whole question is one of scalars. With d the gap that a
//! span's old force leaves after its ends have moved, C its compliance, t the cable's direction and f = λt at its two ends a, b,
//! and σ the material that has slid back through the contact before and after it (s at a fixed place grows by σ),
//!
//! ```text
//! ΔT_a = −tₐ·C⁻¹(d + f_b σ_after − fₐ σ_before),      ΔT_b = −t_b·C⁻¹(the same)
//! contact: σ = 0 where T₂ is within what sliding makes of T₁ at ±μ; σ ≤ 0 at +μ, σ ≥ 0 at −μ
//! ```
//!
//! (that a contact's end moves along the boundary takes as much of the cable as of the chord). This is a linear
//! complementarity problem with three diagonals, solved by changing what is on the wrong side until nothing is: G. Zoutendijk's
//! active sets in their simplest form. Its answer is a guess: Newton's method judges each contact again.

use super::history::Mode;
use super::strand::{Course, Strand, Tie};
use crate::math::{Mat2, Vec2};

/// Rounds of changing sides, over two for each contact.
const MORE_ROUNDS: usize = 6;

/// A span to first order.
#[derive(Clone, Copy, Debug, Default)]
struct Bar {
    /// Tension at both ends were nothing to slide, N.
    tension: [f64; 2],
    /// Change of tension at each end by σ before and after it, N/m.
    by: [[f64; 2]; 2],
}

/// A contact to first order.
#[derive(Clone, Copy, Debug, Default)]
struct Link {
    /// Tension at its start as it is, N.
    from: f64,
    /// Tension that sliding with −μ and +μ makes of that, N, and its derivative; None where it is not ours to say.
    reach: Option<[(f64, f64); 2]>,
    /// −1, 0, +1: slides back, sticks, slides on.
    side: i8,
    sigma: f64,
}

/// Memory of a guess.
#[derive(Clone, Debug, Default)]
pub(super) struct Foresight {
    bars: Vec<Bar>,
    links: Vec<Link>,
    /// Upper diagonal and right-hand side of the elimination.
    swept: Vec<(f64, f64)>,
}

/// Gives each contact the mode that the step will ask for, as far as that can be foreseen.
pub(super) fn foresee(strand: &mut Strand, course: &Course, memory: &mut Foresight) {
    if course.drag > 0.0 || !strand.contacts.iter().any(|c| course.friction(c) > 0.0) {
        return;
    }
    strand.take_tensions(course);
    memory.bars.clear();
    memory.bars.extend((0..strand.spans()).map(|k| bar(strand, course, k).unwrap_or_default()));
    memory.links.clear();
    memory.links.extend((0..strand.contacts.len()).map(|j| link(strand, course, j)));
    if !memory.settle() {
        return;
    }
    for (c, l) in strand.contacts.iter_mut().zip(&memory.links) {
        let friction = course.friction(c);
        if l.reach.is_some() && friction > 0.0 {
            c.mode = if l.side == 0 { Mode::Hold } else { Mode::Slide(friction * f64::from(l.side)) };
        }
    }
}

fn bar(strand: &Strand, course: &Course, k: usize) -> Option<Bar> {
    if !strand.has_span(k) {
        return None;
    }
    let (from, to) = strand.material(k);
    let forces = [strand.force(course, k, from), strand.force(course, k, to)];
    let [Some(a), Some(b)] = strand.ends_of(course, k) else {
        // What hangs keeps its force.
        return Some(Bar { tension: forces.map(|f| f.norm()), ..Bar::default() });
    };
    let (way, compliance) = course.chain(from, to).reach(forces[0]);
    let stiffness: Mat2 = compliance.try_inverse()?;
    let pulled = stiffness * (way - (b - a));
    let rates = forces.map(|f| course.rate(f));
    let at = |f: Vec2| {
        let t = f / f.norm();
        (f.norm() - t.dot(&pulled), [t.dot(&(stiffness * rates[0])), -t.dot(&(stiffness * rates[1]))])
    };
    let [(start, by_start), (end, by_end)] = forces.map(at);
    Some(Bar { tension: [start, end], by: [by_start, by_end] })
}

fn link(strand: &Strand, course: &Course, j: usize) -> Link {
    let c = &strand.contacts[j];
    let e = &c.ends;
    let ties = [(j == 0).then(|| strand.ties[0]), (j + 1 == strand.contacts.len()).then(|| strand.ties[1])];
    let lies = ties.iter().flatten().any(|t| matches!(t, Tie::Lies(_) | Tie::Loose(_)));
    let mut out = Link { from: e.t[0], ..Link::default() };
    if lies || strand.in_pocket(j, 0) || strand.in_pocket(j, 1) || !(e.p[1] > e.p[0] && e.t[0] > 0.0) {
        return out;
    }
    let (track, friction) = (course.track(c), course.friction(c));
    out.reach = Some([-friction, friction].map(|m| {
        let way = track.slide(e.p[0], e.p[1], e.t[0], m);
        (way.tension, way.by_tension)
    }));
    // What is smooth always slides.
    out.side = if friction > 0.0 { 0 } else { 1 };
    out
}

impl Foresight {
    /// Finds sides and slips that agree; false where that comes to no end.
    fn settle(&mut self) -> bool {
        for _ in 0..2 * self.links.len() + MORE_ROUNDS {
            if !self.solve() {
                return false;
            }
            if !self.change() {
                return true;
            }
        }
        false
    }

    /// The slips for the sides as they are: three diagonals.
    fn solve(&mut self) -> bool {
        self.swept.clear();
        let mut before = (0.0, 0.0);
        for (j, l) in self.links.iter().enumerate() {
            let reach = l.reach.and_then(|r| match l.side {
                0 => None,
                side => Some(r[usize::from(side > 0)]),
            });
            before = match reach {
                None => (0.0, 0.0),
                Some((made, by)) => {
                    let (one, two) = (&self.bars[j], &self.bars[j + 1]);
                    // T₂ − what is made of T₁ = 0.
                    let lower = -by * one.by[1][0];
                    let middle = two.by[0][0] - by * one.by[1][1];
                    let rest = made + by * (one.tension[1] - l.from) - two.tension[0];
                    let pivot = middle - lower * before.0;
                    (two.by[0][1] / pivot, (rest - lower * before.1) / pivot)
                }
            };
            self.swept.push(before);
        }
        let mut after = 0.0;
        for (l, (upper, rest)) in self.links.iter_mut().zip(&self.swept).rev() {
            l.sigma = rest - upper * after;
            after = l.sigma;
        }
        self.links.iter().all(|l| l.sigma.is_finite())
    }

    /// Changes the sides that disagree with the slips; whether there was any.
    fn change(&mut self) -> bool {
        let sigma = |links: &[Link], j: Option<usize>| j.and_then(|j| links.get(j)).map_or(0.0, |l| l.sigma);
        let mut changed = false;
        for j in 0..self.links.len() {
            let l = self.links[j];
            let Some([(low, by_low), (high, by_high)]) = l.reach else { continue };
            if low == high {
                continue;
            }
            let side = if l.side == 0 {
                let (before, after) = (sigma(&self.links, j.checked_sub(1)), sigma(&self.links, Some(j + 1)));
                let (one, two) = (&self.bars[j], &self.bars[j + 1]);
                let grown = one.tension[1] + one.by[1][0] * before - l.from;
                let reached = two.tension[0] + two.by[0][1] * after;
                if reached > high + by_high * grown {
                    1
                } else if reached < low + by_low * grown {
                    -1
                } else {
                    0
                }
            } else if l.sigma * f64::from(l.side) > 0.0 {
                0
            } else {
                l.side
            };
            changed |= side != l.side;
            self.links[j].side = side;
        }
        changed
    }
}

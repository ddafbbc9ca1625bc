//! Contacts, holds and loads divide the cable of a first guess into pieces.

use crate::math::Vec2;
use crate::model::fem::elastica::boundary_value::{ContactSurface, Elastica, ElasticaPiece, End, Joint};
use crate::model::fem::elastica::guess::{Attachment, ElasticaGuess, SAME_PLACE_FRACTION};
use crate::model::fem::elastica::reference_curve::ReferenceCurve;
use crate::model::fem::free::places;

/// Part of the rise over two rounds that the sag between them may reach before the cable lies on
/// the line between: a cable that sags by less is lifted off it. Smaller: more contacts that the
/// solver must give up; larger: more that it must find. A choice, tuned on no campaign.
const LIFTED_SAG_FRACTION: f64 = 0.25;

/// First number of elements of a free piece, and of one that lies on a contact. Smaller: Newton's
/// method starts outside its region of convergence; larger: more time.
const FREE_ELEMENTS: usize = 32;
/// See `FREE_ELEMENTS`.
const LYING_ELEMENTS: usize = 8;

/// Boundary layer λ with which the continuation in EI begins, as a fraction of the shortest free
/// piece. Larger: its first guess, a flexible cable with layers, is too rough; smaller: more steps.
const FIRST_LAYER: f64 = 0.05;

/// Shortest free piece that counts for `FIRST_LAYER`, as a fraction of the cable's length.
const LEAST_FREE_PIECE_FRACTION: f64 = 1e-6;

/// Length of a contact with a line, in layers λ, below which it is a point.
const POINT_LAYERS: f64 = 4.0;

/// Sine of the angle between a clamp and a surface below which their directions are equal
/// (round-off).
const SAME_DIRECTION_SINE: f64 = 1e-9;

/// Fraction of an arc that is given up where two contacts leave no cable between them.
const SURRENDERED_ARC_FRACTION: f64 = 0.25;

/// Turn of the curve (rad) from just before an attachment to just after it.
fn turn_over(curve: &ReferenceCurve<'_>, a: &Attachment, length: f64) -> f64 {
    (curve.angle_at(a.from, [0.0, a.from]) - curve.angle_at(a.to, [a.to, length])).abs()
}

impl ElasticaGuess<'_> {
    /// Reduces the bending stiffness to the value with which the continuation begins.
    pub(super) fn reduce_stiffness(&mut self) {
        let elastica = &mut self.elastica;
        let (mut last, mut shortest) = (0.0, elastica.length);
        for a in &self.attachments {
            let free = a.from - last;
            if free > LEAST_FREE_PIECE_FRACTION * elastica.length && free < shortest {
                shortest = free;
            }
            last = a.to;
        }
        let free = elastica.length - last;
        if free > LEAST_FREE_PIECE_FRACTION * elastica.length && free < shortest {
            shortest = free;
        }
        let layer = FIRST_LAYER * shortest;
        let soft = elastica.scale * layer * layer;
        if soft < elastica.bending {
            elastica.bending = soft;
        }
    }

    /// Divides the cable at its attachments; None where two of them leave no cable between them.
    pub(super) fn divide(&mut self) -> Option<()> {
        self.make_short_contacts_points();
        self.leave_ends_to_their_holds();
        self.drop_lifted_lines();
        self.part_neighbours()?;
        self.make_pieces()
    }

    /// Turns contacts that are too short for the stiffness into points: a stretch on a round begins
    /// where σM/EI reaches 1/ρ.
    fn make_short_contacts_points(&mut self) {
        let (elastica, curve, length) = (&self.elastica, &self.curve, self.elastica.length);
        for a in &mut self.attachments {
            let Joint::ContactBegin(k) = a.joint else { continue };
            let turn = turn_over(curve, a, length);
            let pull = curve.tension_at(0.5 * (a.from + a.to));
            let is_point = match elastica.contacts[k].radius {
                Some(r) => 1.0 - (0.5 * turn).min(std::f64::consts::PI).cos() < elastica.bending / (2.0 * pull * r * r),
                None => {
                    a.to - a.from < POINT_LAYERS * elastica.layer_thickness(pull)
                        && a.to < (1.0 - SAME_PLACE_FRACTION) * length
                        && a.from > SAME_PLACE_FRACTION * length
                }
            };
            if is_point {
                let middle = 0.5 * (a.from + a.to);
                *a = Attachment { from: middle, to: middle, joint: Joint::PointContact(k) };
            }
        }
    }

    /// Leaves some free cable at an end that cannot touch the surface right at its support: where a
    /// clamp and the surface have different directions, or where a hinge stands on a round, which
    /// would need a moment there.
    fn leave_ends_to_their_holds(&mut self) {
        let (elastica, curve, length) = (&self.elastica, &self.curve, self.elastica.length);
        // `out`: +1 where the cable leaves the end, −1 where it comes to it.
        let lies_from = |end: &End, contact: &ContactSurface, out: f64| match end {
            // A clamp that points into the surface cannot turn the cable there.
            End::Held(at, Some(angle)) => {
                let rises = out * Vec2::new(angle.cos(), angle.sin()).dot(&contact.gap(*at).1);
                rises < SAME_DIRECTION_SINE && contact.curvature() == 0.0
            }
            End::Held(_, None) => contact.curvature() == 0.0,
            End::Loaded(_) => true,
        };
        for a in &mut self.attachments {
            let Joint::ContactBegin(k) = a.joint else { continue };
            let contact = &elastica.contacts[k];
            let part = |s: f64| {
                (POINT_LAYERS * elastica.layer_thickness(curve.tension_at(s)))
                    .min(SURRENDERED_ARC_FRACTION * (a.to - a.from))
            };
            let (first, last) = (part(a.from), part(a.to));
            if a.from <= SAME_PLACE_FRACTION * length && !lies_from(&elastica.ends[0], contact, 1.0) {
                a.from += first;
            }
            if a.to >= (1.0 - SAME_PLACE_FRACTION) * length && !lies_from(&elastica.ends[1], contact, -1.0) {
                a.to -= last;
            }
        }
    }

    /// Drops contacts with lines between two rounds if the boundary layers beside these lift the
    /// cable off: they lift it by λ/2 times their turn, and its weight makes it sag by wl²/8T.
    fn drop_lifted_lines(&mut self) {
        let (elastica, curve, attachments) = (&self.elastica, &self.curve, &self.attachments);
        let turn_over_round = |j: Option<usize>| {
            let a = attachments.get(j?)?;
            let (Joint::ContactBegin(k) | Joint::PointContact(k)) = a.joint else { return None };
            elastica.contacts[k].radius?;
            Some(turn_over(curve, a, elastica.length))
        };
        let is_lifted = |i: usize| {
            let Joint::ContactBegin(k) = attachments[i].joint else { return false };
            let (Some(a), Some(b)) = (turn_over_round(i.checked_sub(1)), turn_over_round(Some(i + 1))) else {
                return false;
            };
            let Attachment { from, to, .. } = attachments[i];
            let (l, pull) = (to - from, curve.tension_at(0.5 * (from + to)));
            elastica.contacts[k].radius.is_none()
                && elastica.body.norm() * l * l / (8.0 * pull)
                    < LIFTED_SAG_FRACTION * elastica.layer_thickness(pull) * (a + b)
        };
        let stays: Vec<bool> = (0..attachments.len()).map(|i| !is_lifted(i)).collect();
        let mut keep = stays.iter();
        self.attachments.retain(|_| keep.next().copied().unwrap_or(true));
    }

    /// Leaves some cable between any two attachments; None if there is none.
    fn part_neighbours(&mut self) -> Option<()> {
        let attachments = &mut self.attachments;
        for i in 1..attachments.len() {
            let need = 0.5 * self.elastica.layer_thickness(self.curve.tension_at(attachments[i].from));
            let lack = need - (attachments[i].from - attachments[i - 1].to);
            if lack > 0.0 {
                let spare = |a: &Attachment| (SURRENDERED_ARC_FRACTION * (a.to - a.from)).min(0.5 * lack);
                let (before, after) = (spare(&attachments[i - 1]), spare(&attachments[i]));
                attachments[i - 1].to -= before;
                attachments[i].from += after;
            }
            if !(attachments[i].from - attachments[i - 1].to > SAME_PLACE_FRACTION * self.elastica.length) {
                return None;
            }
        }
        Some(())
    }

    /// Makes pieces and joints, and places their nodes along the curve.
    fn make_pieces(&mut self) -> Option<()> {
        let (elastica, curve) = (&mut self.elastica, &self.curve);
        let (length, last) = (elastica.length, self.attachments.len().saturating_sub(1));
        let mut free_from = 0.0;
        for (i, a) in self.attachments.iter().enumerate() {
            let is_stretch = matches!(a.joint, Joint::ContactBegin(_));
            let begins = i == 0 && a.from <= SAME_PLACE_FRACTION * length && is_stretch;
            let ends = i == last && a.to >= (1.0 - SAME_PLACE_FRACTION) * length && is_stretch;
            if !begins {
                elastica.pieces.push(piece_along(elastica, curve, None, [free_from, a.from]));
                elastica.joints.push(a.joint);
            }
            if let Joint::ContactBegin(k) = a.joint {
                elastica.pieces.push(piece_along(elastica, curve, Some(k), [a.from, a.to]));
                if ends {
                    return Some(());
                }
                elastica.joints.push(Joint::ContactEnd(k));
            }
            free_from = a.to;
        }
        if !(length - free_from > SAME_PLACE_FRACTION * length) {
            return None;
        }
        elastica.pieces.push(piece_along(elastica, curve, None, [free_from, length]));
        Some(())
    }
}

/// A piece with its nodes along a curve between two arc lengths, m; `contact` is the one it lies
/// on.
fn piece_along(
    elastica: &Elastica,
    curve: &ReferenceCurve<'_>,
    contact: Option<usize>,
    [from, to]: [f64; 2],
) -> ElasticaPiece {
    let l = to - from;
    let count = if contact.is_some() { LYING_ELEMENTS } else { FREE_ELEMENTS };
    let layers = [from, to].map(|s| elastica.layer_thickness(curve.tension_at(s)));
    let grid: Vec<f64> = if contact.is_some() {
        (0..=count).map(|i| i as f64 / count as f64).collect()
    } else {
        places(layers, l, count).iter().map(|s| s / l).collect()
    };
    let node = |x: &f64| {
        let s = from + x * l;
        let (at, pull) = (curve.position_at(s), curve.tension_at(s));
        let angle = curve.angle_at(s, [from, to]);
        let f = Vec2::new(angle.cos(), angle.sin()) * pull;
        let moment = contact.and_then(|k| elastica.contacts.get(k)).map_or(0.0, |c| elastica.bending * c.curvature());
        [at.x, at.y, angle, moment, f.x, f.y, s, l]
    };
    ElasticaPiece { contact, nodes: grid.iter().map(node).collect(), grid }
}

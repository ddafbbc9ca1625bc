//! These sentences say why a model has no answer. Every sentence names the place, by lengths and
//! names, and a remedy; none holds a number that is not finite.

use super::figures::{Figures, significant, six_digits};
use super::{Sentence, display_in_si};
use crate::error::{
    EquilibriumFault, FailureCause, Near, NearKind, NoEquilibrium, Place, SolveError, SpanError, TensionLoss,
    Unsupported, UnsupportedReach,
};
use crate::units::{Quantity, UnitSystem};

/// A force that no cable bears, N: left over it says that a search ran away, not how much is
/// missing.
const MAX_CREDIBLE_FORCE_N: f64 = 1e9;

display_in_si!(SolveError, NoEquilibrium, FailureCause, Unsupported, SpanError, Place, TensionLoss);

impl std::error::Error for SolveError {}
impl std::error::Error for NoEquilibrium {}
impl std::error::Error for FailureCause {}
impl std::error::Error for Unsupported {}
impl std::error::Error for SpanError {}

impl Sentence for Place {
    fn sentence(&self, units: UnitSystem) -> String {
        let f = Figures(units);
        let mut text = match self.arc_length_m.is_finite() {
            true => format!("{} along the cable", f.distance(self.arc_length_m)),
            false => "somewhere along the cable".to_owned(),
        };
        if self.at_m.iter().all(|c| c.is_finite()) {
            text += &format!(", at ({}, {})", f.distance(self.at_m.x), f.distance(self.at_m.y));
        }
        let Some(Near { kind, name, distance_m }) = &self.near else { return text };
        let kind = match kind {
            NearKind::Support => "support",
            NearKind::Obstacle => "obstacle",
        };
        if distance_m.is_finite() && *distance_m > 0.0 {
            text + &format!(", {} from {kind} `{name}`", f.distance(*distance_m))
        } else {
            text + &format!(", at {kind} `{name}`")
        }
    }
}

impl Sentence for SolveError {
    fn sentence(&self, units: UnitSystem) -> String {
        let f = Figures(units);
        match self {
            Self::NotConverged { model, residual_n, place, .. } => format!(
                "{model} found no resting place: {} {}. Give the cable another route there (route_m), or use another model",
                left_over(f, *residual_n),
                place.sentence(units)
            ),
            Self::TooMuchWork { model, segments, residual_n, place, .. } => format!(
                "{model} gave up its search for a resting place with {segments} segments: {} {}. Draw the route nearer to where the cable will lie, or use fewer segments",
                left_over(f, *residual_n),
                place.sentence(units)
            ),
            Self::Compressed { model, tension_n, place } => {
                let by = if tension_n.is_finite() && *tension_n < 0.0 {
                    format!(" with {}", f.significant(Quantity::Force, -tension_n, 4))
                } else {
                    String::new()
                };
                format!(
                    "{model} found only a state in which the cable pushes{by} {}, and a cable cannot push: it needs more tension there, or another model",
                    place.sentence(units)
                )
            }
            Self::Indefinite { model } => format!(
                "{model} found only a shape that does not stay (it would snap to another): lay the cable on the side where it shall rest (route_m)"
            ),
            Self::TensionLost { model, loss, arc_length_m, at_m } => format!(
                "{model} works for a taut cable only, but here {} {} along it, at {}",
                loss.sentence(units),
                f.length(*arc_length_m, 3),
                f.point((*at_m).into(), 3)
            ),
            Self::NoRestingPlace { why } => format!("the cable cannot come to rest: {}", why.sentence(units)),
            Self::AfterBreak { cable, time_s, arc_length_m, at_m, breaking_n, why } => format!(
                "`{cable}` breaks at {time_s:.4} s, {} along it, at {}, under its breaking tension of {}; what is left of it has no answer without inertia: {}. Run it with inertia, which follows the fall",
                f.length(*arc_length_m, 3),
                f.point((*at_m).into(), 3),
                f.given(Quantity::Force, *breaking_n),
                why.sentence(units)
            ),
            Self::Neither { clearer, other } => format!("{}; and {}", clearer.sentence(units), other.sentence(units)),
            Self::Unsupported { model, feature } => {
                format!("{model} cannot answer this scene: {}", feature.sentence(units))
            }
            Self::NonFinite { quantity, arc_length_m, time_s } => format!(
                "the {quantity} {} along the cable at {} is not a finite number: a time step, a load or a stiffness is far out of proportion to the others",
                f.distance(*arc_length_m),
                if time_s.is_finite() { format!("{} s", six_digits(*time_s)) } else { "no finite time".to_owned() }
            ),
            Self::Buried { model, obstacle, depth_m, arc_length_m, at_m } => format!(
                "{model} cannot go on from where the cable runs through `{obstacle}`: {} inside at {} along it, at {}",
                f.length(*depth_m, 4),
                f.length(*arc_length_m, 3),
                f.point((*at_m).into(), 3)
            ),
            Self::Unsound { model, finding } => {
                format!("the answer of {model} did not pass verification: {}", finding.sentence(units))
            }
            Self::Setting { name, value, allowed: [low, high], quantity } => {
                let value = f.given(*quantity, *value);
                let [low, most] = [*low, *high].map(|end| f.bound(*quantity, end));
                let allowed = match high.is_finite() {
                    true => format!("be between {low} and {}", f.with_unit(*quantity, most)),
                    false => format!("be {} or more, and finite", f.with_unit(*quantity, low)),
                };
                format!("the setting {name} = {value} is not allowed: it must {allowed}")
            }
            Self::TimeStep { dt_s, longest_s } => {
                let most = if longest_s.is_finite() {
                    format!(" and at most {} s", six_digits(*longest_s))
                } else {
                    String::new()
                };
                format!("a time step of {} s cannot be taken: it must be more than 0 s{most}", six_digits(*dt_s))
            }
            Self::StepFailed { model, time_s, dt_s, residual_n, place, cause } => format!(
                "{model} stopped at {time_s:.6} s: the step was halved to {} s and still failed: {} {} ({})",
                significant(*dt_s, 4),
                left_over(f, *residual_n),
                place.sentence(units),
                cause.sentence(units)
            ),
        }
    }
}

/// A force that is left over, where a solver knows one: a figure that is not finite, or beyond all
/// measure, says nothing to anybody.
fn left_over(f: Figures, residual_n: f64) -> String {
    if residual_n.abs() < MAX_CREDIBLE_FORCE_N {
        format!("a force of {} stays unbalanced", f.significant(Quantity::Force, residual_n, 4))
    } else {
        "no balance of forces was reached".to_owned()
    }
}

impl Sentence for NoEquilibrium {
    fn sentence(&self, units: UnitSystem) -> String {
        let f = Figures(units);
        match self {
            Self::NothingHolds => "nothing holds the cable".to_owned(),
            Self::NothingBelow => "no support holds the cable and there is nothing that it could lie on".to_owned(),
            Self::SlidesOff => {
                "nothing holds it where it is laid, and it slides away by more than its length".to_owned()
            }
            Self::NoFriction => "it slides, because there is no friction to hold it where it is laid".to_owned(),
            Self::TooLittleFriction { friction_ratio } => missing_friction(*friction_ratio),
            Self::UnheldForce { left_n, loads_n } => format!(
                "it slides, because nothing holds {} of the {} of load on it",
                f.significant(Quantity::Force, *left_n, 4),
                f.significant(Quantity::Force, *loads_n, 4)
            ),
            Self::ThroughObstacle { obstacle, at_m, arc_length_m } => format!(
                "the cable is laid through `{obstacle}`, at {}, {} along it, and it finds no way out: draw a route_m round it, or leave a way to where its ends are held",
                f.point((*at_m).into(), 3),
                f.length(*arc_length_m, 3)
            ),
            Self::RunsOut { pulley } => format!("the cable runs out through pulley `{pulley}`"),
            Self::RunsOff { pulley } => {
                format!("the cable runs off through pulley `{pulley}`, which nothing holds back")
            }
            Self::LeavesWheel { pulley } => {
                format!("the cable does not press on the wheel of pulley `{pulley}` on the side it runs on")
            }
            Self::Span(error) => error.sentence(units),
        }
    }
}

/// Returns the friction that would hold a cable: three digits, the last one rounded up, so that it
/// is enough.
fn missing_friction(friction_ratio: f64) -> String {
    let more = 100.0 * (friction_ratio - 1.0);
    let digits = (2.0 - more.log10().floor()).clamp(0.0, 9.0);
    let unit = 10f64.powi(-(digits as i32));
    let shown = (more / unit).ceil() * unit;
    format!("it slides; {shown:.0$} % more friction would hold it where it is laid", digits as usize)
}

impl Sentence for SpanError {
    fn sentence(&self, units: UnitSystem) -> String {
        let metres = |length_m: f64| Figures(units).given(Quantity::Length, length_m);
        match *self {
            Self::NotANumber => "a span needs finite numbers, a positive length and a positive stiffness".to_owned(),
            Self::Slack { length_m, chord_m } => format!(
                "a cable of {} without weight is slack over {}: it has no one shape",
                metres(length_m),
                metres(chord_m)
            ),
            Self::TooShort { length_m, chord_m } => {
                format!("an inextensible cable of {} cannot span {}", metres(length_m), metres(chord_m))
            }
            Self::NotConverged { iterations, closure_m } => format!(
                "no resting place was found in {iterations} iterations: the computed end is still {} from its support",
                Figures(units).significant(Quantity::Length, closure_m, 4)
            ),
        }
    }
}

impl Sentence for FailureCause {
    fn sentence(&self, units: UnitSystem) -> String {
        let text = match self {
            Self::EnergyNotFinite => "the energy is not finite",
            Self::StateNotFinite => "not finite",
            Self::TooManyIterations => "too many iterations",
            Self::WorkSpent => "the work for one resting place is spent",
            Self::TangentIndefinite => "the tangent is not positive definite",
            Self::CornerPulls => "a corner would have to pull",
            Self::StickSlipUndecided => "it was not found which corners hold the cable and over which it slips",
            Self::CornerCrossed => "the cable would run through a corner",
            Self::BodyInTheWay => "the cable cannot get out of the way of an obstacle that moves",
            Self::StillMoves => "it never came to rest",
            Self::SlidesAway => "it slides away",
            Self::SupportShort => "a support cannot reach its place",
            Self::NoDescent => "no descent",
            Self::OutOfMemory => "there is no memory for it",
            Self::RunawaySpeed { speed_m_per_s } => {
                return format!("it moves at {} there", Figures(units).significant(Quantity::Speed, *speed_m_per_s, 4));
            }
            Self::NoBalance { iterations } => return format!("no balance in {iterations} iterations"),
        };
        text.to_owned()
    }
}

impl Sentence for Unsupported {
    fn sentence(&self, units: UnitSystem) -> String {
        let f = Figures(units);
        let text = match self {
            Self::BendingStiffness => "the cable has bending stiffness",
            Self::BendingOverPulleys => "bending stiffness over pulleys",
            Self::PlanView => "in plan view the floor rubs everywhere",
            Self::SelfContact => "the cable can touch itself",
            Self::SelfContactWithPulleys => "contact of the cable with itself in a scene with pulleys",
            Self::SelfContactAtStart { arc_length_m } => {
                return format!(
                    "a cable that touches itself where it is laid (near {}): draw it a route that does not",
                    f.length(*arc_length_m, 2)
                );
            }
            Self::Release => "a support lets go",
            Self::Inertia => "motion with inertia",
            Self::MobilisedFriction { towards } => {
                return format!("friction mobilised {towards} (only spans answers that, of a flexible cable at rest)");
            }
            Self::ExternalModel => "it is built by the program that brings it along",
            Self::MovingObstacle => "an obstacle that moves",
            Self::Obstacle { arc_length_m } => {
                return format!("the cable reaches an obstacle {} along it", f.length(*arc_length_m, 3));
            }
            Self::ContactImpossible { arc_length_m, at_m } => {
                let (along, at) = (f.length(*arc_length_m, 3), f.point((*at_m).into(), 3));
                return format!("an obstacle is met {along} along the cable at {at}");
            }
            Self::OffWheel { support } => return format!("the cable lifts off the wheel of `{support}`"),
            Self::BackOnWheel { support } => {
                return format!("the cable comes back to the moving wheel of `{support}`, which it had left");
            }
            Self::NothingHolds => "no support holds the cable, only loads, loose ends or obstacles",
            Self::SupportWithoutPlace => "a support has no place on the cable",
            Self::EndlessContacts { arc_length_m } => {
                return format!("contacts come and go without end near {}", f.length(*arc_length_m, 3));
            }
            Self::CornerPassed { at_m } => {
                return format!("the cable springs past a corner at {}", f.point((*at_m).into(), 3));
            }
            Self::SupportInside { at_m } => {
                return format!("a support is inside an obstacle at {}", f.point((*at_m).into(), 3));
            }
            Self::LoadOnObstacle { arc_length_m } => {
                return format!("the load at {} lies on an obstacle", f.length(*arc_length_m, 3));
            }
            Self::LoadAtPulley { support, arc_length_m } => {
                let along = f.length(*arc_length_m, 3);
                return format!(
                    "the load {along} along the cable reaches the pulley `{support}`: a load on a stiff cable cannot run over a pulley, nor can a load that pulls away from the wheel"
                );
            }
            Self::LooseCableDrawn { arc_length_m } => {
                return format!("loose cable is dragged along, starting at {} along it", f.length(*arc_length_m, 3));
            }
            Self::Unverified { finding, arc_length_m, at_m } => {
                let (along, at) = (f.length(*arc_length_m, 3), f.point((*at_m).into(), 3));
                return format!("{}, {along} along the cable at {at}", finding.sentence(units));
            }
            Self::EmptyState => "the given state has no nodes",
            Self::StateOfOtherLength => "the given state is that of a cable of another length",
            Self::StateOfWholeCable => {
                "the given state is that of a whole cable, but this one has broken (reset first)"
            }
            Self::EditOfBrokenCable => {
                "a broken cable cannot take another length, other supports or other loads (reset first)"
            }
            Self::MotionTooFast { support, speed_m_per_s, time_s, limit_m_per_s } => {
                return format!(
                    "support `{support}` reaches {} at {time_s:.4} s; with inertia its speed may be at most {}",
                    f.fixed(Quantity::Speed, *speed_m_per_s, 1),
                    f.given(Quantity::Speed, *limit_m_per_s)
                );
            }
            Self::Reach(why) => return why.sentence(units),
        };
        text.to_owned()
    }
}

impl Sentence for UnsupportedReach {
    fn sentence(&self, _: UnitSystem) -> String {
        let text = match self {
            Self::NoSuchCable => "there is no such cable",
            Self::SupportWithoutPlace => "the support has no place",
            Self::EmptyGrid => "the grid has no places",
            Self::GridTooLarge => "the grid has too many places",
            Self::HitchWithoutRobot => "the cable hangs on a robot that is not there",
            Self::NoRobot => "the scene has no robot",
            Self::UnknownRobot => "the robot is of no known kind",
            Self::RobotWithoutCable => "no cable hangs on the robot",
            Self::BrokenCable => "the cable has broken",
        };
        text.to_owned()
    }
}

impl Sentence for TensionLoss {
    fn sentence(&self, _: UnitSystem) -> String {
        let text = match self {
            Self::Fold => "a span folds",
            Self::Span => "a span goes slack",
            Self::Lay => "the lying cable goes slack",
        };
        text.to_owned()
    }
}

impl Sentence for EquilibriumFault {
    fn sentence(&self, _: UnitSystem) -> String {
        let text = match self {
            Self::MaterialOrder => "material out of order",
            Self::MaterialAtContactEnd => "material is lost at an end of a contact",
            Self::MaterialAlongContact => "material is lost along a contact",
            Self::Unbalanced => "supports and contacts do not hold the weight and the loads",
            Self::SpanOpen => "a span does not close",
            Self::SpanNotTangent => "a free span does not leave its contact tangentially",
            Self::ContactBeyondBoundary => "a contact goes on beyond what it lies on",
            Self::ContactPulls => "a contact pulls on the cable",
            Self::FrictionBeyondCone => "friction exceeds its limit",
            Self::SlackUnderTension => "a slack part has tension",
            Self::LooseCableSlides => "a loose part slides",
            Self::EndTension => "the tension at a loose end differs from the pull of what hangs on it",
            Self::LoadHeldDown => "a load is held down",
            Self::LoadOutOfKink => "a load is not in the corner where it should rest",
            Self::LoadSlides => "a load slides against more than its friction",
            Self::LoadElsewhere => "a load is not where the cable beside it ends",
            Self::InsideObstacle => "the cable is inside an obstacle",
        };
        text.to_owned()
    }
}

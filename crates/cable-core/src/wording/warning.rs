//! A warning says what happens, where, why, and what can be done.

use super::figures::{Figures, percent};
use super::{Sentence, display_in_si};
use crate::error::NoEquilibrium;
use crate::solution::{EndMove, Histories, ShownEquilibrium, SlideReason, Warning, WarningCause};
use crate::units::{Quantity, UnitSystem};

display_in_si!(Warning);

impl Sentence for Warning {
    fn sentence(&self, units: UnitSystem) -> String {
        use WarningCause as Cause;
        let (f, cable, value, limit) = (Figures(units), &self.cable, self.value, self.limit);
        // The place of a warning, and its value and limit in their unit.
        let place = {
            let at = self.at_m.map_or_else(String::new, |at| format!(" {}", f.point(at, 3)));
            format!("{}{at}", f.length(self.arc_length_m, 3))
        };
        let given = |value: f64| f.given(self.cause.quantity(), value);
        let pulled = |decimals: usize| f.force(value, decimals);
        match &self.cause {
            Cause::AboveService { time_s } => format!(
                "`{cable}` carries {} at {place}{}, above its service tension of {}: it wears out early; lengthen the cable or lighten the load",
                pulled(1),
                instant(*time_s),
                given(limit)
            ),
            Cause::BrieflyAboveBreaking { time_s, breaking_n, held_n, over_s } => format!(
                "`{cable}` carries {} at {place}{}, for an instant, above its service tension of {} and its breaking tension of {}. It does not break, because its mean tension over {over_s} s is at most {}; the height of such a peak depends on damping and mesh",
                pulled(1),
                instant(Some(*time_s)),
                given(limit),
                given(*breaking_n),
                f.force(*held_n, 1)
            ),
            Cause::AboveBreaking { mean } => format!(
                "`{cable}` carries {} at {place}{}, {}above its breaking tension of {}: it would break here; the figures assume that it does not",
                pulled(1),
                instant(mean.map(|m| m.time_s)),
                mean.map_or_else(String::new, |m| format!("averaged over {} s, ", m.over_s)),
                given(limit)
            ),
            Cause::AboveBreakingAfterBreak { mean } => format!(
                "`{cable}` carries {} at {place}{}, averaged over {} s, above its breaking tension of {}, shortly after it broke. A broken piece is not tested for further breaks until the wave of its break has run through it and back, so whether it breaks here too is not known",
                pulled(1),
                instant(Some(mean.time_s)),
                mean.over_s,
                given(limit)
            ),
            Cause::Broke { time_s, over_s, detached_from } => {
                let (how, rest) = match detached_from {
                    Some(support) => (format!("tore off `{support}`"), "the rest goes on without it"),
                    None => ("broke".to_owned(), "the pieces go on apart"),
                };
                let held = if *over_s > 0.0 {
                    format!("the mean of its tension over {over_s} s")
                } else {
                    "its tension".to_owned()
                };
                format!(
                    "`{cable}` {how} at {place} at {time_s:.4} s, where {held} reached its breaking tension of {}: {rest}; pull less, or take a stronger cable",
                    given(limit)
                )
            }
            Cause::BreakageUncertain { broke, held_n, lowest_n, over_s } => format!(
                "`{cable}` {}: its greatest mean tension over {over_s} s is {} ({:.0} to {}, estimated from coarser runs), and it breaks at {}. Pull less, or more slowly",
                if *broke {
                    "broke here, but a finer run may not break it"
                } else {
                    "did not break here, but a finer run may break it"
                },
                f.force(*held_n, 0),
                Quantity::Force.convert(*lowest_n, units),
                pulled(0),
                given(limit)
            ),
            Cause::NarrowGuide | Cause::FreeKink => format!(
                "`{cable}` is bent to a radius of {} at {place}, below {}: {}",
                f.radius(value),
                f.radius(limit),
                if self.cause == Cause::FreeKink {
                    "it kinks there and stays bent; give it more room to turn, or a guide"
                } else {
                    "its strands are overstretched there; guide it round something wider"
                }
            ),
            Cause::Pressure => format!(
                "`{cable}` is pressed against its guide with {} at {place}, above the {} allowed: its insulation is crushed; pull less, or guide it round something wider",
                f.fixed(Quantity::ForcePerLength, value, 0),
                given(limit)
            ),
            Cause::Folds { material_m, ground_m, on_ground } => format!(
                "{} of `{cable}` lies in folds, without tension, on {} of {}, most of it at {place}: a 2D model cannot show layers and loops, so how they lie is not known; shorten the cable or give it more room",
                f.length(*material_m, 2),
                f.length(*ground_m, 2),
                if *on_ground { "ground" } else { "route" }
            ),
            Cause::LowTension { below_n } => format!(
                "{} of `{cable}` near {place} has less than {} of tension: this part may be run over, snag or loop; shorten the cable or pull it in",
                f.length(value, 2),
                f.force(*below_n, 3)
            ),
            Cause::Crossing { other_arc_length_m, count } => format!(
                "`{cable}` crosses itself{}: {} and {} along it ({count} in all); the loop of {} between can tighten into a kink or a knot when it is pulled; lay it without the loop, or draw it in from the slack end",
                self.at_m.map_or_else(String::new, |at| format!(" at {}", f.point(at, 3))),
                f.length(self.arc_length_m, 3),
                f.length(*other_arc_length_m, 3),
                f.length(value, 3)
            ),
            Cause::TightTurn { within_m } => format!(
                "`{cable}` curls up at {place}: it turns {value:.0}° within {}; pulled, the curl closes into a kink; take the turn out of it before pulling",
                f.length(*within_m, 3)
            ),
            Cause::RoundObstacle { obstacle } => format!(
                "`{cable}` goes round `{obstacle}` {value:.2} times at {place}: friction multiplies the pull with every turn and pulling an end does not free it; drive back round it"
            ),
            Cause::Caught { obstacle, first_ratio } => format!(
                "`{cable}` is caught on `{obstacle}` at {place}: it has not slipped there, although the ratio of the tensions on its two sides has grown from {first_ratio:.2} to {value:.2}; the pull goes into the obstacle, not along the cable. Stop, drive back, and guide it past"
            ),
            Cause::Weightless => "The cable has no weight: where it is slack it has no tension and any shape is at rest; this one is that of a very light cable".to_owned(),
            Cause::Unstable => "This resting place is unstable: there is no friction to hold the cable, and the slightest push moves it away".to_owned(),
            Cause::Loose { material_m, ground_m, held_n } => format!(
                "The cable lies loose: {} of it on {} of ground, without tension, so each end carries only what hangs from it. How the slack is folded is not known; it is drawn spread evenly. Laid differently, friction on the slack could pull at the ends with up to {}",
                f.length(*material_m, 3),
                f.length(*ground_m, 3),
                f.force(*held_n, 2)
            ),
            Cause::ManyEquilibria { shown, histories: known } => {
                let shown = match shown {
                    ShownEquilibrium::EvenlyLaid => ". Shown: the one laid evenly along its route with the least sliding",
                    ShownEquilibrium::LeastSliding => ". Shown: the one laid along its route with the least sliding",
                    ShownEquilibrium::Frictionless => ". Shown: the frictionless shape, held by friction",
                    ShownEquilibrium::FromRoute => ". Shown: the one found starting from its route",
                    ShownEquilibrium::FromRouteAsFlexible => ". Shown: the one found starting from its route (the other cases are computed for a flexible cable)",
                };
                let friction = if matches!(known, Histories::SlackElsewhere { .. } | Histories::BowedElsewhere { .. }) { "The" } else { "Because of friction, the" };
                format!("{friction} resting place depends on how the cable was laid{shown}{}", histories(f, known))
            }
            Cause::Blocked { support, obstacle, short_m } => {
                let [from, to] = match self.at_m {
                    Some(at) => [f.point(at, 3), f.point([at[0] + short_m[0], at[1] + short_m[1]], 3)],
                    None => ["where it is".to_owned(), "where it is sent".to_owned()],
                };
                let by = if obstacle.is_empty() { "an obstacle".to_owned() } else { format!("`{obstacle}`") };
                format!("Support `{support}` cannot reach {to}: blocked by {by}, it stopped at {from}")
            }
            Cause::ClearOfWheel { pulley } => {
                format!("The cable hangs clear of the wheel of pulley `{pulley}`, which carries nothing")
            }
            Cause::Lags { support, behind_m } => format!(
                "Support `{support}` is {} behind its target, because it moves at {} at most",
                f.length(*behind_m, 2),
                given(limit)
            ),
            Cause::HandLags { support, behind_m, hand_behind_m, pull_n, stiffness_n_per_m } => {
                let mut parts = Vec::new();
                if let Some(behind_m) = behind_m {
                    parts.push(format!(
                        "it is {} behind the hand that drags it, which pulls with {} through a spring of {}",
                        f.length(*behind_m, 2),
                        f.force(*pull_n, 0),
                        f.fixed(Quantity::ForcePerLength, *stiffness_n_per_m, 0)
                    ));
                }
                if *hand_behind_m > 0.0 {
                    let hand = if behind_m.is_some() { "the hand" } else { "its hand" };
                    let behind = f.length(*hand_behind_m, 2);
                    parts.push(format!("{hand} is {behind} behind its target, because it moves at {} at most", given(limit)));
                }
                format!("Support `{support}`: {}", parts.join("; "))
            }
            Cause::RouteBuried { obstacle } => format!(
                "The route leads {} deep below `{obstacle}`{}: the cable is laid along the surface there",
                f.length(value, 3),
                self.at_m.map_or_else(String::new, |at| format!(" at {}", f.point(at, 3)))
            ),
            Cause::SupportOnSurface { support, obstacle } => format!(
                "Support `{support}` is on the surface of `{obstacle}`: the cable's centre line is held {} off it{}",
                f.length(value, 4),
                self.at_m.map_or_else(String::new, |at| format!(", at {}", f.point(at, 4)))
            ),
            Cause::RobotWithoutGround => format!(
                "The robot stands still and does not drive its path: the terrain ends below its tracks{}",
                self.at_m.map_or_else(String::new, |at| format!(" at {}", f.point(at, 3)))
            ),
            Cause::RobotIgnored { model } => {
                format!("`{cable}` passes through the robot: {model} does not treat the robot as an obstacle; use fem")
            }
            Cause::RobotInObstacle { obstacle } => format!(
                "The robot stands in `{obstacle}`{}: it drives on terrain alone, and nothing else stops it; lead its path clear of it",
                self.at_m.map_or_else(String::new, |at| format!(" at {}", f.point(at, 3)))
            ),
            Cause::SlidFromRoute { why } => format!(
                "The cable cannot rest where it was laid: {}. Shown: the place it slid to; the slide itself is not shown",
                NoEquilibrium::from(*why).sentence(units)
            ),
            Cause::SlidOn => "Nothing held the cable where it was, so it slid to the next place where it can rest. The slide itself is not shown".to_owned(),
            Cause::SpeedCut => format!(
                "`{cable}` moved at {} at {place}{}: its speed was limited to {}. Do not trust the motion from then on; use fem",
                f.fixed(Quantity::Speed, value, 0),
                after(self.since_s),
                given(limit)
            ),
            Cause::TooFast => format!(
                "`{cable}` moves at {} at {place}{}: above {}, air drag and shocks, which no model includes, matter more than what is computed. Such speeds come from the recoil of a break, or from a force or stiffness that is far too great",
                f.fixed(Quantity::Speed, value, 0),
                after(self.since_s),
                given(limit)
            ),
            Cause::EnergyCut => format!(
                "The kinetic energy of `{cable}` reached {}, fastest at {place}{}, but supports, loads and stretch can give only {}: the motion was slowed artificially. Do not trust it; use fem, or more segments",
                f.significant(Quantity::Energy, value, 4),
                after(self.since_s),
                f.significant(Quantity::Energy, limit, 4)
            ),
            Cause::StiffPreview => format!(
                "`{cable}` is too stiff for explicit steps in real time: this is a preview in steps of {} that damps fast motion; use fem, fewer segments or a smaller axial stiffness for figures",
                f.significant(Quantity::Time, value, 3)
            ),
            Cause::EnergyFromNowhere { from_s, work_j, speed_m_per_s } => format!(
                "`{cable}` has gained {} of energy since {from_s:.4} s that nothing explains: at most {} of work was done on it, and rounding is below {}. It is fastest at {place}, at {}. Do not trust the motion from then on; use fem, shorter steps, or damping",
                f.significant(Quantity::Energy, value, 4),
                f.significant(Quantity::Energy, *work_j, 4),
                f.significant(Quantity::Energy, limit, 4),
                f.fixed(Quantity::Speed, *speed_m_per_s, 1)
            ),
            Cause::CornerOfMesh { obstacle, turn_deg, element_m } => {
                let by = if value < 1.0 {
                    format!("{:.0} %", (100.0 * value).ceil())
                } else {
                    "100 % or more".to_owned()
                };
                format!(
                    "The tension of `{cable}` beyond `{obstacle}` at {place} is uncertain by {by}: the cable turns {turn_deg:.0}° there with segments of {}, and the tension jumps as each node passes. Use fem, which lets the cable slide over the corner, or shorter segments if the obstacle is round",
                    f.length(*element_m, 3)
                )
            }
            Cause::CoarseBend { bars } => format!(
                "With {bars} segments the bend of a stiff cable round its guide is accurate to {} of the greatest tension only; {} was asked for: give the cable more segments",
                percent(value),
                percent(limit)
            ),
            Cause::BarContacts => format!(
                "The contacts of this stiff cable are computed with straight segments, which gives the forces to about {} of the greatest tension; {} was asked for",
                percent(value),
                percent(limit)
            ),
            Cause::CoarseForces { elements } => format!(
                "With {elements} segments the forces are accurate to about {} of the greatest tension; {} was asked for: give the cable more segments",
                percent(value),
                percent(limit)
            ),
            Cause::CoarseTension { elements } => format!(
                "With {elements} segments the greatest tension is accurate to about {}; {} was asked for: give the cable more segments",
                percent(value),
                percent(limit)
            ),
            Cause::RobotOutOfBalance { left_n } => format!(
                "The forces of the robot and `{cable}` are {} out of balance in this step, {} of the forces on the robot; {} was asked for, but no robot speed was found that balances them: drive more slowly, or keep the cable from being squeezed",
                f.force(*left_n, 1),
                percent(value),
                percent(limit)
            ),
            Cause::Recorded { message, .. } => message.clone(),
        }
    }
}

fn instant(time_s: Option<f64>) -> String {
    time_s.map_or_else(String::new, |t| format!(" at {t:.4} s"))
}

fn after(time_s: Option<f64>) -> String {
    time_s.map_or_else(String::new, |t| format!(" after {t:.4} s"))
}

/// Returns what other histories would have left, to follow what is said of the one that is shown.
fn histories(f: Figures, known: &Histories) -> String {
    match known {
        Histories::NotSought => "; no other was looked for".to_owned(),
        Histories::NotFound { greatest_n } => format!(
            ". Its greatest tension is {}; how much another way of laying would change it could not be found",
            f.force(*greatest_n, 2)
        ),
        Histories::Mobilised {
            greatest_n,
            towards_start_n,
            towards_end_n,
            loose_n,
            frictionless_n,
            start_n,
            end_n,
        } => {
            let figure = |of: Option<f64>| {
                of.map_or_else(|| "unknown (no resting place was found)".to_owned(), |n| f.force(n, 2))
            };
            format!(
                ". Its greatest tension is {}; drawn towards its start against all friction: {}; drawn towards its end: {}{}{}. In all cases found the tension is {} at the start and {} at the end",
                f.force(*greatest_n, 2),
                figure(*towards_start_n),
                figure(*towards_end_n),
                loose_n.map_or_else(String::new, |n| format!("; laid down loose: {}", f.force(n, 2))),
                frictionless_n.map_or_else(String::new, |n| format!(
                    "; in the frictionless shape, held by friction: {}",
                    f.force(n, 2)
                )),
                f.forces(*start_n),
                f.forces(*end_n)
            )
        }
        Histories::SlackElsewhere { greatest_n, others_n, start_n, end_n }
        | Histories::BowedElsewhere { greatest_n, others_n, start_n, end_n } => {
            let others: Vec<String> = others_n.iter().map(|n| f.force(*n, 2)).collect();
            let slack = matches!(known, Histories::SlackElsewhere { .. });
            let otherwise = if slack { "with the slack in another span" } else { "bowed to another side" };
            format!(
                ". Its greatest tension is {}; {otherwise} it would be {}. In all these cases the tension is {} at the start and {} at the end",
                f.force(*greatest_n, 2),
                others.join(" or "),
                f.forces(*start_n),
                f.forces(*end_n)
            )
        }
        Histories::EndsMoved { greatest_n, moves, start_n, end_n, range_n } => {
            let each = |m: &EndMove| {
                let what = if m.drawn_out_m < 0.0 { "moved in" } else { "pulled out" };
                let (by, left) = (f.length(m.drawn_out_m.abs(), 3), f.force(m.greatest_n, 2));
                format!("after `{}` is {what} by {by} and returned: {left}", m.support)
            };
            format!(
                ". Its greatest tension is {} as laid; {}. In all these cases the tension is {} at the start and {} at the end, and the greatest tension is {}",
                f.force(*greatest_n, 2),
                moves.iter().map(each).collect::<Vec<_>>().join("; "),
                f.forces(*start_n),
                f.forces(*end_n),
                f.forces(*range_n)
            )
        }
    }
}

impl From<SlideReason> for NoEquilibrium {
    fn from(why: SlideReason) -> Self {
        match why {
            SlideReason::NoFriction => Self::NoFriction,
            SlideReason::TooLittleFriction { friction_ratio } => Self::TooLittleFriction { friction_ratio },
            SlideReason::UnheldForce { left_n, loads_n } => Self::UnheldForce { left_n, loads_n },
            SlideReason::NothingHolds => Self::SlidesOff,
        }
    }
}

//! These modules find the contacts of a section's answer: after each solve one kind of change is
//! made, until none is needed.
//!
//! | room | what changes |
//! |---|---|
//! | `release` | a contact that would have to pull is removed, or one that has vanished |
//! | `merge` | two neighbouring contacts of one chain become one |
//! | `obstacle_search` | nothing: the point at which a free span runs deepest into an obstacle |
//! | `span_landing` | a span that runs into an obstacle is laid down on it |
//! | `load_landing` | where a load or a cable end runs into an obstacle |
//! | `cycle_detection` | nothing: contacts that come back to where they were |
//! | `edge_crossing` | ends of contacts go over edges, along which nothing turns |
//!
//! Loads, kinks, wheels and slack have their own changes, in `contact`.

mod cycle_detection;
mod edge_crossing;
pub(in crate::model::spans) mod load_landing;
mod merge;
mod obstacle_search;
mod release;
mod span_landing;

use crate::contact::World;
use crate::contact::swept_corners::ImpassableCorner;
use crate::math::Vec2;
use crate::model::spans::changes::cycle_detection::CycleSearch;
use crate::model::spans::changes::edge_crossing::follow_edges;
use crate::model::spans::changes::merge::merge_contacts;
use crate::model::spans::changes::release::{lifted_wheel, release_turned_contact, release_vanishing_contact};
use crate::model::spans::changes::span_landing::{SolvePurpose, touch_obstacles, touch_passed_corner};
use crate::model::spans::contact::{kink_load, point_load, release_below, slack_pocket};
use crate::model::spans::newton;
use crate::model::spans::newton::{Converged, Workspace};
use crate::model::spans::section::{CableSection, Failure, SolveContext};

/// Solves a section and changes its contacts until they are consistent with its answer.
///
/// `route` is the shape from which a first equilibrium is sought. It may be far away: then the
/// cable touches the corners between.
pub(in crate::model::spans) fn solve(
    section: &mut CableSection,
    context: &mut SolveContext,
    world: &World,
    corners: &[ImpassableCorner],
    route: Option<&[Vec2]>,
    workspace: &mut Workspace,
) -> Result<Converged, Failure> {
    let tuned = context.settings.changes;
    let purpose = if route.is_some() { SolvePurpose::FirstEquilibrium } else { SolvePurpose::Step };
    let (mut sum, mut caught, mut cycle) = (Converged::default(), 0, CycleSearch::default());
    for _ in 0..tuned.max_changes {
        point_load::join(section, context)?;
        let found = match newton::solve(section, context, workspace) {
            Ok(found) => found,
            Err(stall) => {
                sum.iterations += stall.iterations;
                if follow_edges(section, context) || kink_load::enter(section, context) {
                    continue;
                }
                caught += 1;
                if caught <= tuned.max_load_releases
                    && (release_vanishing_contact(section, context)? || point_load::set_down_at_end(section, context))
                {
                    continue;
                }
                if let Some(support) = lifted_wheel(section, context) {
                    return Err(Failure::OffWheel { support });
                }
                let s = section.material(stall.at).0;
                return Err(Failure::Stalled { iterations: sum.iterations, residual: stall.residual, s });
            }
        };
        sum.iterations += found.iterations;
        sum.residual = found.residual;
        if cycle.returns(section) {
            break;
        }
        // Tunnelled corners are checked before penetrations: they tell on which side of an obstacle
        // the cable belongs.
        let changed = release_turned_contact(section, context)?
            || merge_contacts(section, context)
            || release_below::part(section, context)
            || kink_load::enter(section, context)
            || point_load::settle(section, context)?
            || slack_pocket::open(section, context)
            || match route {
                Some(route) => touch_passed_corner(section, context, corners, route, workspace)?,
                None => false,
            }
            || touch_obstacles(section, context, world, purpose)?;
        if !changed {
            // Other contacts may press the cable on to its wheel again, so it counts as off its
            // wheel only when nothing else changes.
            return lifted_wheel(section, context).map_or(Ok(sum), |support| Err(Failure::OffWheel { support }));
        }
    }
    Err(Failure::ContactCycling { s: section.from })
}

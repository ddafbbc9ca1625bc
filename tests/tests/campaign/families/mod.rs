//! These are the families: each draws a case from chance.

mod air;
mod ground;
mod plan;
mod stiff;
mod things;

use crate::case::Case;
use crate::chance::Chance;

/// A family: its name and how it draws a case.
pub type Family = (&'static str, fn(&mut Chance) -> Case);

/// Every family.
pub const FAMILIES: &[Family] = &[
    ("taut span", air::taut),
    ("slack span", air::slack),
    ("vertical pair", air::vertical),
    ("ends in one place", air::same_place),
    ("loads, wind and heat", air::loads),
    ("end that hangs free", air::hangs_free),
    ("end with a dead load", air::load_end),
    ("held in between", air::held_between),
    ("weightless span", air::weightless),
    ("even pulleys", air::even_pulleys),
    ("uneven pulleys", air::uneven_pulleys),
    ("even posts", air::even_posts),
    ("gravity 0", air::no_gravity),
    ("span at any scale", air::any_scale),
    ("clamps in the air", air::clamps),
    ("segments in the air", air::segments),
    ("span by mass-spring", air::by_mass_spring),
    ("presets", air::presets),
    ("mooring without friction", ground::smooth_mooring),
    ("mooring with friction", ground::rough_mooring),
    ("mooring on a slope", ground::sloped_mooring),
    ("slack mooring", ground::slack_mooring),
    ("slack on a floor", ground::slack_floor),
    ("ends on the ground", ground::ends_on_ground),
    ("one end above another", ground::above),
    ("pits and crests", ground::pits),
    ("terraces and walls", ground::terraces),
    ("rough ground", ground::rough),
    ("free end on the ground", ground::free_end),
    ("loaded end on the ground", ground::loaded_end),
    ("lump on the ground", ground::lump),
    ("loads on ground", ground::lying_loads),
    ("slope near its cone", ground::cone),
    ("ground at any scale", ground::any_scale),
    ("ground by fem", ground::by_fem),
    ("ground by mass-spring", ground::by_mass_spring),
    ("wind over ground", ground::wind),
    ("post", things::over_post),
    ("under a post", things::under_post),
    ("round a post", things::round_post),
    ("beam", things::beam),
    ("slack over things", things::slack),
    ("loads over a post", things::capstan),
    ("supports in things", things::buried),
    ("tank with beams", things::tank),
    ("thin walls", things::thin),
    ("smooth wheels", things::wheels),
    ("rubbing wheels", things::rubbing_wheels),
    ("self-contact", things::self_contact),
    ("stiff in the air", stiff::air),
    ("stiff clamped", stiff::clamped),
    ("stiff on ground", stiff::ground),
    ("stiff over a post", stiff::post),
    ("stiff over a corner", stiff::corner),
    ("stiff free end", stiff::free_end),
    ("plan view slack", plan::slack),
    ("plan view posts", plan::posts),
    ("plan view boxes", plan::boxes),
    ("plan view free end", plan::free_end),
];

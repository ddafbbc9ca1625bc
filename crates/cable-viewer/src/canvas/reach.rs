//! The safe reach over the map: a band along the ground in the colour of what there and back costs the cable, as a share of what it
//! may bear; what it may not bear is hatched, where it does not reach the band ends.

use cable_core::robot::reach::{Map, Place};
use egui::{Color32, Mesh, Pos2, Stroke, vec2};

use super::view::View;
use crate::reach::Progress;
use crate::state::AppState;
use crate::units;

/// Height of the band below the ground, points.
const BAND: f32 = 9.0;

/// Draws it; its ends go to `figures` for the labels to place.
pub fn draw(view: &View<'_>, state: &AppState, figures: &mut Vec<(Pos2, String, Color32)>) {
    let Progress::Done((map, _)) = &state.reach else { return };
    let mut mesh = Mesh::default();
    for pair in map.places.windows(2) {
        let base = mesh.vertices.len() as u32;
        for p in pair {
            let Some(colour) = colour(view, map, p) else { continue };
            let at = view.at(p.at_m) + vec2(0.0, 2.0);
            mesh.colored_vertex(at, colour);
            mesh.colored_vertex(at + vec2(0.0, BAND), colour);
        }
        if mesh.vertices.len() as u32 == base + 4 {
            mesh.add_triangle(base, base + 1, base + 2);
            mesh.add_triangle(base + 1, base + 3, base + 2);
        } else {
            mesh.vertices.truncate(base as usize);
        }
    }
    view.painter.add(mesh);
    over(view, map);
    let Some(ends) = map.safe_m(map.service_n) else { return };
    for (x, name) in ends.into_iter().zip(["safe from", "safe to"]) {
        let Some(place) = map.places.iter().find(|p| p.at_m[0] >= x) else { continue };
        let at = view.at(place.at_m);
        view.painter.vline(at.x, at.y - 12.0..=at.y + BAND + 2.0, Stroke::new(1.6, view.palette.accent));
        let (length, _) = units::of_length();
        figures.push((at, format!("{name} {} {length}", units::coordinate(place.at_m[0], 0.01)), view.palette.accent));
    }
}

/// Of a place: by the share of the service tension; None where the cable does not reach.
fn colour(view: &View<'_>, map: &Map, p: &Place) -> Option<Color32> {
    let share = p.there_and_back_n / map.service_n;
    if !share.is_finite() {
        return None;
    }
    if share > 1.0 {
        return Some(view.palette.risk);
    }
    Some(crate::colour::ColourMap::Cividis.at(share))
}

/// Strokes across what is above the service tension: its colour is not all that tells it.
fn over(view: &View<'_>, map: &Map) {
    for pair in map.places.windows(2) {
        if pair.iter().all(|p| p.there_and_back_n > map.service_n && p.there_and_back_n.is_finite()) {
            let [a, b] = [view.at(pair[0].at_m), view.at(pair[1].at_m)];
            for k in 0..3 {
                let at = a + (b - a) * (k as f32 / 3.0) + vec2(0.0, 2.0);
                view.painter.line_segment([at, at + vec2(5.0, BAND)], Stroke::new(1.2, view.palette.background));
            }
        }
    }
}

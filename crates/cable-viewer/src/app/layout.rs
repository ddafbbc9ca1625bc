//! Where panels and canvas are.

use egui::{CentralPanel, CollapsingHeader, Frame, Panel, ScrollArea, Ui};

use super::menu;
use crate::canvas;
use crate::command::Command;
use crate::panels;
use crate::state::AppState;

type PanelUi = fn(&mut Ui, &AppState, &mut Vec<Command>);

/// Draws everything but dialogs. Only the canvas needs the state mutable: it fits the camera to its own size.
pub fn ui(ui: &mut Ui, state: &mut AppState, commands: &mut Vec<Command>) {
    Panel::top("menu").show(ui, |ui| menu::ui(ui, state, commands));
    Panel::bottom("status").show(ui, |ui| menu::status(ui, state));
    Panel::bottom("playback").show(ui, |ui| panels::playback::ui(ui, state, commands));
    Panel::left("edit").default_size(336.0).size_range(220.0..=420.0).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            section(ui, "Scene", panels::scene::ui, state, commands);
            section(ui, "Cable", panels::cable::ui, state, commands);
            section(ui, "Environment", panels::environment::ui, state, commands);
            section(ui, "Solver", panels::solver::ui, state, commands);
        });
    });
    Panel::right("read").default_size(320.0).size_range(200.0..=420.0).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            section(ui, "Warnings", panels::warnings::ui, state, commands);
            section(ui, "Readouts", panels::readouts::ui, state, commands);
        });
    });
    Panel::bottom("plots").resizable(true).default_size(240.0).size_range(120.0..=500.0).show(ui, |ui| {
        // A panel takes the height of what is in it: without this it shrinks by a margin a frame.
        ui.set_min_height(ui.available_height());
        panels::plots::ui(ui, state, commands);
    });
    CentralPanel::no_frame().frame(Frame::NONE).show(ui, |ui| canvas::ui(ui, state, commands));
}

fn section(ui: &mut Ui, title: &str, panel: PanelUi, state: &AppState, commands: &mut Vec<Command>) {
    CollapsingHeader::new(title).default_open(true).show_unindented(ui, |ui| panel(ui, state, commands));
}

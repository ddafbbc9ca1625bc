//! `cable-viewer [SCENE]`: opens the window, or draws it to a file.

use std::path::PathBuf;
use std::process::ExitCode;

use cable_core::scene::catalog;
use cable_core::{Model, Scene};
use cable_viewer::ViewerApp;
use cable_viewer::app::{documentation_pictures, screenshot};
use cable_viewer::command::Command;
use cable_viewer::io::{autosave, scene_file};
use cable_viewer::render::software_adapter_shader::SoftwarePainter;
use clap::Parser;

/// The cable simulator's window.
#[derive(Parser)]
#[command(version, about)]
struct WindowArguments {
    /// Scene file to open; left out: the first scene of the catalogue.
    scene: Option<PathBuf>,
    /// Draw the window to this PNG file instead of opening it.
    #[arg(long, value_name = "FILE")]
    screenshot: Option<PathBuf>,
    /// Draw the pictures of docs/gallery.md into this folder instead of opening the window.
    #[arg(long, value_name = "FOLDER")]
    gallery: Option<PathBuf>,
    /// Size of the window or picture, in points.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800", value_parser = parse_size)]
    size: [u32; 2],
    /// Colours of the window or picture.
    #[arg(long, value_enum, default_value_t = Theme::System)]
    theme: Theme,
    /// Model to solve with: auto, catenary, spans, fem or mass-spring.
    #[arg(long, default_value = "auto", value_parser = parse_model)]
    model: Model,
}

/// A model by its name on the command line.
fn parse_model(text: &str) -> Result<Model, String> {
    Model::from_name(text).ok_or_else(|| "one of auto, catenary, spans, fem, mass-spring".to_owned())
}

/// Colours of the window.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Theme {
    /// As the system has it; dark where it does not say.
    System,
    /// Dark on light.
    Light,
    /// Light on dark.
    Dark,
}

/// Largest picture side, pixels: what every GPU can draw.
const MAX_PIXELS: u32 = 8192;

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    match sides {
        Some(size) if size.iter().all(|s| (1..=MAX_PIXELS).contains(s)) => Ok(size),
        _ => Err(format!("write it as 1280x800, each side 1 to {MAX_PIXELS}")),
    }
}

fn main() -> ExitCode {
    match run(WindowArguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("cable-viewer: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Saves the pictures asked for, or runs the window.
fn run(arguments: WindowArguments) -> Result<(), String> {
    if let Some(folder) = arguments.gallery {
        return documentation_pictures::save(&folder);
    }
    let (scene, path) = first_scene(arguments.scene)?;
    let theme = match arguments.theme {
        Theme::System => egui::ThemePreference::System,
        Theme::Light => egui::ThemePreference::Light,
        Theme::Dark => egui::ThemePreference::Dark,
    };
    if let Some(picture) = arguments.screenshot {
        return screenshot::save(scene, &picture, arguments.size, |app, ctx| {
            app.state.view.theme = theme;
            app.apply(ctx, vec![Command::SetModel(arguments.model)]);
        });
    }
    let size = arguments.size.map(|s| s as f32);
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Cable simulator")
            .with_inner_size(size)
            .with_min_inner_size([640.0, 400.0]),
        ..eframe::NativeOptions::default()
    };
    let create = Box::new(|cc: &eframe::CreationContext<'_>| {
        let software = cc.wgpu_render_state.as_ref().and_then(SoftwarePainter::of);
        let mut app = ViewerApp::new(&cc.egui_ctx, scene, path);
        if let Some(software) = software {
            cc.egui_ctx.add_plugin(software);
            app.draw_in_software();
        }
        app.state.view.theme = theme;
        if let Some(path) = autosave::default_path() {
            app.enable_autosave(path);
        }
        app.apply(&cc.egui_ctx, vec![Command::SetModel(arguments.model)]);
        Ok(Box::new(app) as Box<dyn eframe::App>)
    });
    eframe::run_native("cable-viewer", options, create).map_err(|e| explain(&e))
}

/// The scene of a file, or the first of the catalogue.
fn first_scene(path: Option<PathBuf>) -> Result<(Scene, Option<PathBuf>), String> {
    match path {
        Some(path) => {
            let scene = scene_file::load(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            Ok((scene, Some(path)))
        }
        None => {
            let first = catalog::all().into_iter().next();
            Ok((first.map(|(_, s)| s).ok_or("the catalogue is empty: name a scene file")?, None))
        }
    }
}

/// One sentence with the remedy for what keeps a window from opening.
fn explain(error: &eframe::Error) -> String {
    match error {
        eframe::Error::WinitEventLoop(_) | eframe::Error::Winit(_) => {
            let whole = error.to_string(); // begins with the place in winit's source
            format!(
                "no window can be opened here: no display answers ({}); run it in a desktop session or set DISPLAY, \
                 or draw a picture with --screenshot FILE",
                whole.rsplit(": ").next().unwrap_or(&whole)
            )
        }
        eframe::Error::Wgpu(_) => format!(
            "no graphics adapter was found ({error}); install a Vulkan driver \
             (Debian: mesa-vulkan-drivers) or try WGPU_BACKEND=gl"
        ),
        other => format!("the window could not be opened: {other}"),
    }
}

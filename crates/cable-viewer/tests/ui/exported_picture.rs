//! The canvas is written to a picture file with what its legend says.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, ViewCommand};
use cable_viewer::state::Item;
use cable_viewer::state::dialog::Dialog;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open, select};

fn type_path(harness: &mut Harness<'_, ViewerApp>, typed: &std::path::Path) {
    match &mut harness.state_mut().state.ui.dialog {
        Some(Dialog::ExportPicture { path }) => *path = typed.display().to_string(),
        other => panic!("{other:?}"),
    }
    harness.run_steps(2);
    harness.get_by_label("Save").click();
    harness.run_steps(3);
}

#[test]
fn the_canvas_is_exported_with_its_legend_and_stays_as_it_is() {
    let folder = std::env::temp_dir().join(format!("cable-viewer-canvas-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut harness = open(catalog::over_beam());
    select(&mut harness, Item::Cable(0));
    apply(&mut harness, Command::View(ViewCommand::SetTheme(egui::ThemePreference::Light)));
    harness.run_steps(2);
    let canvas = harness.get_by_label("Canvas").rect();
    let before = (harness.state().state.view.camera, harness.state().state.selection.selected);

    harness.get_by_label("File").click();
    harness.run_steps(3);
    harness.get_by_label("Export picture…").click();
    harness.run_steps(3);
    // Another ending is refused, and what was typed is asked again.
    type_path(&mut harness, &folder.join("scene.jpg"));
    harness.get_by_label_contains("must end in .png or .svg");
    apply(&mut harness, Command::File(FileCommand::SetDialog(None)));
    let file = folder.join("scene.png");
    type_path(&mut harness, &file);
    harness.get_by_label("Saved scene.png");

    let picture = image::open(&file).unwrap().to_rgb8();
    std::fs::remove_dir_all(&folder).unwrap();
    // Two pixels a point; the caption stands above the canvas.
    assert_eq!(picture.width(), 2 * canvas.width().round() as u32);
    let caption = picture.height() - 2 * canvas.height().round() as u32;
    assert!((80..200).contains(&caption), "{caption}");
    // Light as the window is, with every colour of the map in the caption and the cable below.
    let scale = harness.state().state.view.colour.map;
    let near = |p: &image::Rgb<u8>, of: egui::Color32| p.0.iter().zip(of.to_array()).all(|(a, b)| a.abs_diff(b) < 12);
    for share in [0.1, 0.5, 0.9] {
        let colour = scale.at(share);
        let rows = |from: u32, to: u32| picture.enumerate_pixels().filter(move |(_, y, _)| (from..to).contains(y));
        assert!(rows(0, caption).any(|(.., p)| near(p, colour)), "{share} is not in the legend");
        assert!(rows(caption, picture.height()).any(|(.., p)| near(p, colour)), "{share} is not on the cable");
    }
    assert!(picture.get_pixel(4, 4).0.iter().all(|v| *v > 200));
    assert_eq!(before, (harness.state().state.view.camera, harness.state().state.selection.selected));
}

/// Issue 20: the canvas could be had as pixels only.
#[test]
fn issue_020_the_canvas_is_exported_as_svg_with_words_and_lines() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.svg");
    let mut harness = open(catalog::tank());
    apply(&mut harness, Command::File(FileCommand::ExportPicture(file.clone())));
    harness.run_steps(2);
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
    assert_eq!(text.matches("<g ").count(), text.matches("</g>").count());
    for word in [">Tank", ">x (m)<", "verified"] {
        assert!(text.contains(word), "{word}");
    }
    // The cable in the colours of its map, and no figure that cannot be drawn.
    let most = harness.state().state.view.colour.map.at(1.0).to_array();
    let near = |c: &str| {
        let part = |k: usize| c.get(2 * k..2 * k + 2).and_then(|p| u8::from_str_radix(p, 16).ok());
        (0..3).all(|k| part(k).is_some_and(|v| v.abs_diff(most[k]) < 12))
    };
    let polygons = text.lines().filter(|l| l.starts_with("<polygon"));
    assert!(polygons.filter_map(|l| l.split("fill=\"#").nth(1)).any(near));
    assert!(text.matches("<line ").count() > 50 && text.matches("<polygon ").count() > 3);
    for wrong in ["NaN", "inf\"", "<image"] {
        assert!(!text.contains(wrong), "{wrong}");
    }
    if let Some(to) = std::env::var_os("KEEP_PICTURES") {
        std::fs::copy(&file, std::path::Path::new(&to).join("canvas.svg")).unwrap();
    }
}

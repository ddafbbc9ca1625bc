//! A path is picked from a list of the folder it is in, or in the system's own dialog.

use std::path::{MAIN_SEPARATOR, Path};
use std::time::{Duration, Instant};

use egui::{Id, ScrollArea, Ui};

use crate::io::folder::{self, Listing};
use crate::widgets::field;

/// Height of the list, points.
const HEIGHT: f32 = 170.0;
/// Longest time for which a listing is shown before the folder is read again. Shorter: a slow disk
/// is read every frame; longer: a file that was just written is missed.
const MAX_LISTING_AGE: Duration = Duration::from_secs(2);
/// No hand cancels a dialog within this time: there was none.
const MIN_DIALOG_TIME: Duration = Duration::from_millis(300);

/// The purpose of the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathPurpose {
    /// An existing file or folder is chosen for reading.
    Open,
    /// A file is chosen for writing: its typed name stays when another folder is entered.
    Save,
}

impl PathPurpose {
    /// The word on the button that does it.
    #[must_use]
    pub fn verb(self) -> &'static str {
        match self {
            Self::Open => "Open",
            Self::Save => "Save",
        }
    }
}

/// The list of a folder, and when it was read.
type CachedListing = (Result<Listing, String>, Instant);

/// Lists the folder of the typed path; a click enters a folder or puts a file into the path.
/// Returns whether a file was double-clicked.
pub fn list(ui: &mut Ui, path: &mut String, endings: &[&str], purpose: PathPurpose) -> bool {
    let folder = folder::of(path);
    let id = Id::unique("path picker").with((&folder, endings));
    let known = ui.data(|d| d.get_temp::<CachedListing>(id)).filter(|(_, read)| read.elapsed() < MAX_LISTING_AGE);
    let (listing, read) = known.unwrap_or_else(|| (folder::list(&folder, endings), Instant::now()));
    ui.data_mut(|d| d.insert_temp(id, (listing.clone(), read)));
    ui.add_space(4.0);
    ui.add(egui::Label::new(egui::RichText::new(folder.display().to_string()).weak()).truncate());
    let mut chosen = false;
    match listing {
        Err(why) => field::fault(ui, &format!("This folder cannot be read: {why}")),
        Ok(listing) => {
            let area = ScrollArea::vertical().id_salt(id).max_height(HEIGHT).min_scrolled_height(HEIGHT);
            area.auto_shrink([false, true]).show(ui, |ui| chosen = rows(ui, path, &listing, purpose));
        }
    }
    chosen
}

/// The folder above, folders and files; whether a file was double-clicked.
fn rows(ui: &mut Ui, path: &mut String, listing: &Listing, purpose: PathPurpose) -> bool {
    ui.spacing_mut().item_spacing.y = 1.0;
    let mut chosen = false;
    let typed = Path::new(path.trim());
    let folder_part =
        typed.file_name().filter(|_| purpose == PathPurpose::Save && !typed.is_dir()).unwrap_or_default().to_owned();
    // Joined with nothing, a folder ends in a separator: the name is typed behind it.
    let enter = |folder: &Path| folder.join(&folder_part).display().to_string();
    if let Some(above) = listing.folder.parent()
        && ui.selectable_label(false, "..").on_hover_text("The folder above").clicked()
    {
        *path = enter(above);
    }
    for name in &listing.folders {
        let row = ui.selectable_label(false, format!("{name}{MAIN_SEPARATOR}"));
        if row.on_hover_text("Opens this folder").clicked() {
            *path = enter(&listing.folder.join(name));
        }
    }
    for name in &listing.files {
        let file = listing.folder.join(name);
        let text = file.display().to_string();
        let row = ui.selectable_label(*path == text, name).on_hover_text("Double-click takes it at once");
        chosen |= row.double_clicked();
        if row.clicked() {
            *path = text;
        }
    }
    if listing.folders.is_empty() && listing.files.is_empty() {
        ui.weak("Nothing here to pick");
    }
    chosen
}

/// A button for the system's own file dialog; where none answers, that is said.
pub fn system(ui: &mut Ui, path: &mut String, purpose: PathPurpose) {
    let id = Id::unique("system file dialog is missing");
    let help = "The system's file dialog; where there is none, pick from the list below";
    if ui.button("Browse…").on_hover_text(help).clicked() {
        let dialog = rfd::FileDialog::new().add_filter("scene", &["toml"]);
        let began = Instant::now();
        let picked = match purpose {
            PathPurpose::Open => dialog.pick_file(),
            PathPurpose::Save => dialog.set_file_name("scene.toml").save_file(),
        };
        ui.data_mut(|d| d.insert_temp(id, picked.is_none() && began.elapsed() < MIN_DIALOG_TIME));
        if let Some(picked) = picked {
            *path = picked.display().to_string();
        }
    }
    if ui.data(|d| d.get_temp(id)).unwrap_or(false) {
        ui.weak("No system dialog answers");
    }
}

//! The page of pictures has every state that the program draws, and each of them with a sentence.

use cable_viewer::app::gallery::STATES;

#[test]
fn the_gallery_has_a_picture_of_each_state() {
    let page = include_str!("../../../../docs/gallery.md");
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/gallery");
    for state in &STATES {
        assert_eq!(page.matches(&format!("](gallery/{}.png)", state.name)).count(), 1, "{}", state.name);
        let picture = std::fs::read(format!("{folder}/{}.png", state.name)).expect("drawn by --gallery docs/gallery");
        assert!(picture.len() > 20_000, "{} is hardly a picture", state.name);
    }
    assert_eq!(page.matches("![").count(), STATES.len());
}

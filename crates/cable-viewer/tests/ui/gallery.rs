//! The page of pictures has every state that the program draws, and each of them with a sentence.

use cable_viewer::app::documentation_pictures::STATES;

#[test]
fn the_gallery_has_a_picture_of_each_state() {
    let page = include_str!("../../../../docs/gallery.md");
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/gallery");
    for state in &STATES {
        assert_eq!(page.matches(&format!("](gallery/{}.png)", state.name)).count(), 1, "{}", state.name);
        let picture = std::fs::read(format!("{folder}/{}.png", state.name)).expect("drawn by --gallery docs/gallery");
        assert!(picture.len() > 20_000, "{} is hardly a picture", state.name);
    }
    // Pictures of the window before it was laid out anew stand beside those of the same state.
    for state in &STATES {
        assert_eq!(page.matches(&format!("](gallery/before/{}.png)", state.name)).count(), 1, "{}", state.name);
        let [kept, present] = ["before/", ""].map(|f| image::open(format!("{folder}/{f}{}.png", state.name)).unwrap());
        assert_eq!((kept.width(), kept.height()), (present.width(), present.height()), "{}", state.name);
    }
    assert_eq!(page.matches("![").count(), 2 * STATES.len());
}

/// Pictures of an earlier window had stayed on the page. Those that are drawn at once are compared;
/// the status bar says how long it took and is left out.
#[test]
fn pictures_of_the_gallery_are_those_of_the_present_window() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/gallery");
    let (mut old, mut compared) = (Vec::new(), 0);
    for state in STATES.iter().filter(|s| s.rests()) {
        let kept = image::open(format!("{folder}/{}.png", state.name)).unwrap().to_rgb8();
        let drawn = image::DynamicImage::from(state.draw().unwrap()).to_rgb8();
        assert_eq!(kept.dimensions(), drawn.dimensions(), "{}", state.name);
        let body = |y: u32| y < kept.height() - 30;
        let differs = |a: &[u8], b: &[u8]| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 32);
        let other = kept.enumerate_pixels().filter(|(x, y, p)| body(*y) && differs(&p.0, &drawn.get_pixel(*x, *y).0));
        let other = other.count();
        // A figure that differs in its last digit is some 30 pixels.
        if other > 1000 {
            old.push(format!("{}: {other} pixels", state.name));
        }
        compared += 1;
    }
    assert_eq!(compared, 4);
    assert!(old.is_empty(), "draw them with --gallery docs/gallery and look at them: {old:?}");
}

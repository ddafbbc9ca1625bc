//! This example prints a random scene of the campaign `tests/folds.rs` by its number:
//! `cargo run -p cable-core --example fold_scene -- 12`.

#[allow(clippy::unwrap_used, dead_code)] // the campaign uses all of it
#[path = "../tests/fold_scenes/mod.rs"]
mod fold_scenes;

fn main() {
    let seed = std::env::args().nth(1).and_then(|word| word.parse().ok()).unwrap_or(0);
    print!("{}", fold_scenes::scene(seed).1.to_toml());
}

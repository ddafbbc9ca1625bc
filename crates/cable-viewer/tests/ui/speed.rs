//! These tests print how fast the window is drawn, and assert nothing of it: cables of 1000 and 100
//! 000 segments over ground of 1000 points at 1280×800, through the same renderer as the pictures,
//! in software where there is no GPU.
//!
//! The figures: `cargo test --workspace --test ui speed -- --nocapture --test-threads 1`.

use std::time::Instant;

use cable_core::scene::{Obstacle, Shape, catalog};
use cable_core::{Model, Scene};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::render::software_adapter_shader::SoftwarePainter;
use eframe::egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor, wgpu};
use egui::Vec2;
use egui_kittest::{Harness, TestRenderer};

use crate::gpu::render_state;

/// Frames that are measured.
const FRAMES: usize = 20;

/// A cable of so many segments hung over ground of so many points.
pub fn big(segments: usize, points: usize) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.name = format!("{segments} segments over {points} points");
    scene.cables[0].segments = Some(segments);
    let ground = |k: usize| {
        let x = -2.0 + 14.0 * k as f64 / (points - 1) as f64;
        [x, 0.2 + 0.25 * (1.3 * x).sin() + 0.04 * (23.0 * x).sin()]
    };
    let shape = Shape::Terrain { points_m: (0..points).map(ground).collect() };
    scene.obstacles.push(Obstacle { name: "ground".to_owned(), shape, friction: None });
    scene
}

/// The screen does what a window does with a frame: it tessellates it, hands it to the graphics
/// driver and waits for the picture. Nothing is read back: a window shows it where it is.
struct Screen {
    state: RenderState,
    view: Option<wgpu::TextureView>,
}

impl Screen {
    fn new() -> Result<Self, String> {
        Ok(Self { state: render_state(RendererOptions::default())?, view: None })
    }
}

impl TestRenderer for Screen {
    fn handle_delta(&mut self, delta: &mut egui::TexturesDelta) {
        let mut renderer = self.state.renderer.write();
        for (id, images) in delta.set.drain() {
            for image in images {
                renderer.update_texture(&self.state.device, &self.state.queue, id, &image);
            }
        }
        for id in delta.free.drain() {
            renderer.free_texture(&id);
        }
    }

    fn render(&mut self, ctx: &egui::Context, output: &egui::FullOutput) -> Result<image::RgbaImage, String> {
        let (device, queue) = (&self.state.device, &self.state.queue);
        let size = ctx.content_rect().size();
        let size_in_pixels = [size.x as u32, size.y as u32];
        let screen = ScreenDescriptor { pixels_per_point: ctx.pixels_per_point(), size_in_pixels };
        let view = self.view.get_or_insert_with(|| {
            let [width, height] = size_in_pixels;
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: self.state.target_format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        });
        let jobs = ctx.tessellate(output.shapes.clone(), ctx.pixels_per_point());
        let mut renderer = self.state.renderer.write();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: None });
        let before = renderer.update_buffers(device, queue, &mut encoder, &jobs, &screen);
        {
            let attachment = wgpu::RenderPassColorAttachment {
                view,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
                depth_slice: None,
            };
            let descriptor =
                wgpu::RenderPassDescriptor { color_attachments: &[Some(attachment)], ..Default::default() };
            let mut pass = encoder.begin_render_pass(&descriptor).forget_lifetime();
            renderer.render(&mut pass, &jobs, &screen);
        }
        queue.submit(before.into_iter().chain(std::iter::once(encoder.finish())));
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| e.to_string())?;
        Ok(image::RgbaImage::new(1, 1))
    }
}

/// Milliseconds of each part of a frame in order: median, 95 %.
fn figures(mut ms: Vec<f64>) -> String {
    ms.sort_by(f64::total_cmp);
    let at = |share: f64| ms[((ms.len() - 1) as f64 * share).round() as usize];
    format!("median {:.1} ms, 95 % {:.1} ms", at(0.5), at(0.95))
}

/// CPU time of this process so far, s, of all its threads: what a frame costs, whoever else uses
/// the machine. Linux only.
fn cpu_s() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // After the name, which may hold spaces: user and system time are the 12th and 13th, in
    // hundredths.
    let mut fields = stat.rsplit(')').next()?.split_whitespace().skip(11);
    let mut next = || fields.next()?.parse::<f64>().ok();
    Some((next()? + next()?) / 100.0)
}

/// CPU time of this thread so far, s; not a number where it is not known. Linux only.
fn thread_cpu_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    stat.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok()).map_or(f64::NAN, |ns| ns * 1e-9)
}

/// The whole program in a window of 1280×800.
fn window(renderer: Screen, software: Option<SoftwarePainter>, scene: Scene) -> Harness<'static, ViewerApp> {
    Harness::builder()
        .with_size(Vec2::new(1280.0, 800.0))
        .with_step_dt(1.0 / 60.0)
        .with_render_cursor(false)
        .with_accessibility_check(false)
        .renderer(renderer)
        .build_eframe(|cc| {
            software.into_iter().for_each(|s| cc.egui_ctx.add_plugin(s));
            ViewerApp::inline(&cc.egui_ctx, scene, None)
        })
}

fn draw(name: &str, mut scene: Scene, taken_over: bool) {
    // The ground is only drawn: what is measured is not how the cable was found.
    let ground = std::mem::take(&mut scene.obstacles);
    let renderer = match Screen::new() {
        Ok(renderer) => renderer,
        Err(why) => return eprintln!("{name}: not measured, {why}"),
    };
    let software = SoftwarePainter::of(&renderer.state).filter(|_| taken_over);
    let mut harness = window(renderer, software, scene);
    let ctx = harness.ctx.clone();
    harness.state_mut().apply(&ctx, vec![Command::SetModel(Model::Fem)]);
    harness.run_steps(4);
    assert_eq!(harness.state().state.live.snapshot.error, None);
    harness.state_mut().state.document.scene.obstacles = ground;
    harness.run_steps(2);
    harness.render().unwrap();
    let ctx = harness.ctx.clone();
    let cpu = cpu_s();
    let (mut laid, mut drawn, began) = (Vec::new(), Vec::new(), Instant::now());
    for k in 0..FRAMES {
        // Nothing on the canvas is where it was a frame ago.
        let to = if k % 2 == 0 { Vec2::new(3.0, 1.0) } else { Vec2::new(-3.0, -1.0) };
        let from = Instant::now();
        harness.state_mut().apply(&ctx, vec![Command::View(ViewCommand::Pan(to))]);
        harness.step();
        laid.push(from.elapsed().as_secs_f64() * 1e3);
        let from = Instant::now();
        harness.render().unwrap();
        drawn.push(from.elapsed().as_secs_f64() * 1e3);
    }
    let rate = FRAMES as f64 / began.elapsed().as_secs_f64();
    let work = match (cpu_s(), cpu) {
        (Some(after), Some(before)) => format!("{:.0} ms of CPU a frame", (after - before) * 1e3 / FRAMES as f64),
        _ => "CPU time not known".to_owned(),
    };
    println!("{name}: {rate:.1} frames a second, {work}; laid out {}; drawn {}", figures(laid), figures(drawn));
}

#[test]
fn speed_of_drawing() {
    for (segments, points) in [(20, 2), (1000, 1000), (100_000, 1000)] {
        for (how, taken_over) in [("egui's shader", false), ("our own", true)] {
            draw(&format!("{segments} segments, {points} points of ground, {how}"), big(segments, points), taken_over);
        }
    }
}

/// Ground from a table with so many points, printed and not asserted.
#[test]
fn speed_of_import() {
    use std::fmt::Write as _;
    for count in [100_000, 1_000_000] {
        let mut text = String::with_capacity(24 * count);
        for k in 0..count {
            let x = k as f64 * 1e-4;
            let _ = writeln!(text, "{x:.4},{:.5}", -4.0 + 0.2 * (0.7 * x).sin() + 0.001 * (913.0 * x).sin());
        }
        let began = Instant::now();
        let read = cable_core::scene::import::read(&text, 1.0).unwrap();
        let parsed = began.elapsed().as_secs_f64();
        let mut scene = catalog::hanging_span();
        let points_m = read.lines[0].points_m.clone();
        scene.obstacles.push(Obstacle {
            name: "ground".to_owned(),
            shape: Shape::Terrain { points_m },
            friction: None,
        });
        let began = Instant::now();
        assert_eq!(scene.validate(), Ok(()));
        let validated = began.elapsed().as_secs_f64();
        let began = Instant::now();
        let mut harness = crate::open(catalog::hanging_span());
        let ready = began.elapsed().as_secs_f64();
        let import =
            cable_viewer::command::FileCommand::ImportMap { path: None, text, unit_m: 1.0, replaces_ground: false };
        let ctx = harness.ctx.clone();
        let began = Instant::now();
        harness.state_mut().apply(&ctx, vec![Command::File(import)]);
        harness.step();
        println!(
            "{count} points: read {parsed:.2} s, checked {validated:.2} s, in the window and solved {:.2} s \
             (an empty window takes {ready:.2} s)",
            began.elapsed().as_secs_f64()
        );
        assert_eq!(harness.state().state.live.snapshot.error, None);
    }
}

/// Drawn by our own shader the window looks as egui draws it, but for the rounding of the font's
/// edges.
#[test]
fn software_drawing_looks_the_same() {
    [1.0, 1.5].into_iter().for_each(software_drawing_looks_the_same_at);
}

fn software_drawing_looks_the_same_at(scale: f32) {
    let picture = |taken_over: bool| {
        let options = RendererOptions { dithering: false, ..RendererOptions::default() };
        let state = match render_state(options) {
            Ok(state) => state,
            Err(why) if std::env::var("CI").is_ok_and(|v| v == "true") => panic!("{why}"),
            Err(why) => {
                eprintln!("skipped, {why}");
                return None;
            }
        };
        let software = SoftwarePainter::of(&state).filter(|_| taken_over);
        let mut harness = Harness::builder()
            .with_size(Vec2::new(1100.0, 640.0))
            .with_pixels_per_point(scale)
            .with_render_cursor(false)
            .with_accessibility_check(false)
            .renderer(egui_kittest::wgpu::WgpuTestRenderer::from_render_state(state))
            .build_eframe(|cc| {
                software.into_iter().for_each(|s| cc.egui_ctx.add_plugin(s));
                ViewerApp::inline(&cc.egui_ctx, catalog::robot_drive(), None)
            });
        harness.run_steps(6);
        // A popup is drawn over the rest, and a font of another size makes the atlas grow.
        let state = &mut harness.state_mut().state;
        state.ui.dialog = Some(cable_viewer::state::dialog::Dialog::About);
        // The time it took is another every time.
        (state.live.snapshot.solve_wall_s, state.live.latest.solve_wall_s) = (1e-3, 1e-3);
        harness.run_steps(3);
        Some(harness.render().unwrap())
    };
    let (Some(by_egui), Some(own)) = (picture(false), picture(true)) else { return };
    if let Some(folder) = std::env::var_os("KEEP_PICTURES") {
        own.save(std::path::Path::new(&folder).join("own.png")).unwrap();
        by_egui.save(std::path::Path::new(&folder).join("egui.png")).unwrap();
    }
    assert_eq!(by_egui.dimensions(), own.dimensions());
    let most = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| (0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap_or(0);
    let differences: Vec<u8> = by_egui.pixels().zip(own.pixels()).map(most).collect();
    let share = |least: u8| differences.iter().filter(|d| **d > least).count() as f64 / differences.len() as f64;
    assert!(share(2) < 1e-3 && share(40) == 0.0, "at {scale} {} of the pixels differ, {} much", share(2), share(40));
}

/// A window of which only what changes is drawn, frame by frame, looks as if its last frame was
/// drawn at once: while time runs, a pointer wanders, dialogs come and go, fonts grow and the theme
/// changes.
#[test]
fn a_picture_drawn_in_parts_looks_as_if_drawn_at_once() {
    use cable_viewer::command::{FileCommand, PlaybackCommand};
    use cable_viewer::state::dialog::Dialog;
    let frames = |each_drawn: bool, stop: usize| {
        let state = match render_state(RendererOptions { dithering: false, ..RendererOptions::default() }) {
            Ok(state) => state,
            Err(why) if std::env::var("CI").is_ok_and(|v| v == "true") => panic!("{why}"),
            Err(why) => {
                eprintln!("skipped, {why}");
                return None;
            }
        };
        let software = SoftwarePainter::of(&state)?;
        let mut harness = Harness::builder()
            .with_size(Vec2::new(1100.0, 640.0))
            .with_pixels_per_point(1.25)
            .with_step_dt(1.0 / 60.0)
            .with_render_cursor(false)
            .with_accessibility_check(false)
            .renderer(egui_kittest::wgpu::WgpuTestRenderer::from_render_state(state))
            .build_eframe(|cc| {
                cc.egui_ctx.add_plugin(software);
                ViewerApp::inline(&cc.egui_ctx, catalog::robot_drive(), None)
            });
        let ctx = harness.ctx.clone();
        for k in 0..stop {
            let command = match k {
                3 => Some(Command::Playback(PlaybackCommand::SetPaused(false))),
                12 => Some(Command::Playback(PlaybackCommand::SetPaused(true))),
                14 => Some(Command::File(FileCommand::SetDialog(Some(Dialog::About)))),
                17 => Some(Command::File(FileCommand::SetDialog(None))),
                19 => Some(Command::View(ViewCommand::SetTheme(egui::ThemePreference::Light))),
                21 => Some(Command::View(ViewCommand::Pan(Vec2::new(7.0, -3.0)))),
                _ => None,
            };
            harness.state_mut().apply(&ctx, command.into_iter().collect());
            harness.hover_at(egui::pos2(40.0 * k as f32, 25.0 * k as f32));
            harness.step();
            let live = &mut harness.state_mut().state.live;
            // The time it took is another every time.
            (live.snapshot.solve_wall_s, live.latest.solve_wall_s) = (1e-3, 1e-3);
            let solver = &mut harness.state_mut().state.solver;
            (solver.solving_s, solver.edit_latency_s) = (None, Some(0.01));
            if each_drawn {
                harness.render().unwrap();
            }
        }
        Some(harness.render().unwrap())
    };
    for stop in [6, 12, 16, 18, 20, 24] {
        let (Some(in_parts), Some(at_once)) = (frames(true, stop), frames(false, stop)) else { return };
        let different = in_parts.pixels().zip(at_once.pixels()).filter(|(a, b)| a != b).count();
        if let Some(folder) = std::env::var_os("KEEP_PICTURES") {
            let folder = std::path::Path::new(&folder);
            in_parts.save(folder.join(format!("parts-{stop}.png"))).unwrap();
            at_once.save(folder.join(format!("once-{stop}.png"))).unwrap();
        }
        assert_eq!(different, 0, "pixels after {stop} frames");
    }
}

/// A window whose graphs show all of a million samples of a held run and of a history that is full,
/// printed and not asserted: a 60th of a second is 16.7 ms.
#[test]
fn speed_of_graphs() {
    use cable_viewer::record::kept_run::KeptRun;
    use cable_viewer::record::sample::Sample;
    use cable_viewer::record::sample_history::SampleHistory;
    let sample = |k: u32| {
        let t = f64::from(k) / 240.0;
        let pull = 500.0 + 80.0 * (0.7 * t).sin() + 20.0 * (31.0 * t).sin();
        Sample {
            time_s: t,
            max_tension_n: pull,
            energy_j: [pull, 2.0, 3.0, 4.0],
            robot: None,
            reactions_n: vec![[pull, 20.0], [-0.9 * pull, 30.0]],
        }
    };
    let renderer = match Screen::new() {
        Ok(renderer) => renderer,
        Err(why) => return eprintln!("not measured, {why}"),
    };
    let software = SoftwarePainter::of(&renderer.state);
    let mut harness = window(renderer, software, catalog::hanging_span());
    harness.run_steps(4);
    let all = cable_viewer::plot::GraphView { window_s: None, ..cable_viewer::plot::GraphView::default() };
    harness.ctx.data_mut(|d| d.insert_temp(egui::Id::unique("plot view"), all));
    for (name, held, live) in
        [("empty graphs", 0, 2), ("a million held", 1_000_000, 2), ("a million held, history full", 1_000_000, 400_000)]
    {
        let state = &mut harness.state_mut().state;
        let solution = state.live.snapshot.solution.clone().expect("an answer");
        (state.analysis.references, state.live.history) = (Vec::new(), SampleHistory::default());
        (0..live).for_each(|k| state.live.history.push(sample(k)));
        if held > 0 {
            let samples: Vec<Sample> = (0..held).map(sample).collect();
            let run =
                KeptRun::of(samples.iter(), &[(*solution).clone(), (*solution).clone()], 0).map(std::sync::Arc::new);
            assert_eq!(
                run.as_ref().map(|r| r
                    .line(cable_viewer::record::plotted_quantity::Measure::ALL[0])
                    .map_or(0, |l| l.points().len())),
                Some(held as usize)
            );
            let scene = state.live.snapshot.scene.clone().expect("a scene");
            state.analysis.references.push(cable_viewer::state::Reference {
                scene,
                changes: Vec::new(),
                folder: None,
                solution,
                wall_s: 0.0,
                run,
            });
        }
        harness.run_steps(3);
        harness.render().unwrap();
        let (mut laid, mut worked, mut whole) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..5 * FRAMES {
            let (from, cpu) = (Instant::now(), thread_cpu_s());
            harness.step();
            let jobs = harness.ctx.tessellate(harness.output().shapes.clone(), 1.0);
            laid.push(from.elapsed().as_secs_f64() * 1e3);
            worked.push((thread_cpu_s() - cpu) * 1e3);
            assert!(!jobs.is_empty());
        }
        for _ in 0..FRAMES {
            let from = Instant::now();
            harness.step();
            harness.render().unwrap();
            whole.push(from.elapsed().as_secs_f64() * 1e3);
        }
        let samples = harness.state().state.live.history.samples.len();
        println!(
            "graphs, {name} ({samples} samples live): laid out and cut into triangles {}, CPU {}; drawn as well {}",
            figures(laid),
            figures(worked),
            figures(whole)
        );
    }
}

use cable_core::model::Inertia;
use cable_core::scene::catalog;
use cable_core::{Model, Settings, Simulation};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let model = if a[1] == "fem" { Model::Fem } else { Model::Auto };
    let mut scene = catalog::all().into_iter().find(|(n, _)| *n == a[2]).unwrap().1;
    if let Some(n) = a.get(4) {
        for c in &mut scene.cables {
            c.segments = Some(n.parse().unwrap());
        }
    }
    let end: f64 = a[3].parse().unwrap();
    let mut sim = Simulation::with_settings(scene, model, Settings::default()).unwrap();
    if let Err(e) = sim.settle() {
        println!("{e}");
    }
    if end < 0.0 {
        let s = sim.solution();
        for c in &s.cables {
            for n in &c.nodes {
                println!(
                    "   s {:.4} x {:.4} {:.4} T {:.4} F {:.4} {:.4}",
                    n.arc_length_m, n.x_m, n.y_m, n.tension_n, n.force_n[0], n.force_n[1]
                );
            }
            for k in &c.contacts {
                println!(
                    "   {} s {:.4} {:.4} N {:.4} F {:.4} {:?} turn {:.2} T {:.4} {:.4} n {:?} at {:.4} {:.4}",
                    k.obstacle,
                    k.begins_m,
                    k.ends_m,
                    k.normal_n,
                    k.friction_n,
                    k.state,
                    k.turn_deg,
                    k.tension_before_n,
                    k.tension_after_n,
                    k.normal,
                    k.x_m,
                    k.y_m
                );
                for q in &k.samples {
                    println!("        {:.4} {:?}", q.arc_length_m, q.force_n);
                }
            }
        }
        return;
    }
    let mut most = 0.0f64;
    let t0 = std::time::Instant::now();
    loop {
        let r = sim.step_quasi_static(1.0 / 60.0);
        let s = sim.solution();
        most = most.max(sim.max_tension().tension_n);
        if let Err(e) = r {
            println!("{} {e}", s.time_s);
            for f in s.verification.as_ref().map(|v| v.findings.clone()).unwrap_or_default() {
                println!("  {f}");
                let at = f.arc_length_m;
                for c in &s.cables {
                    for n in &c.nodes {
                        if (n.arc_length_m - at).abs() < 80.0 {
                            println!(
                                "   s {:.4} x {:.4} {:.4} T {:.4} F {:.4} {:.4}",
                                n.arc_length_m, n.x_m, n.y_m, n.tension_n, n.force_n[0], n.force_n[1]
                            );
                        }
                    }
                    for k in &c.contacts {
                        if k.begins_m < at + 80.0 && k.ends_m > at - 80.0 {
                            println!(
                                "   {} s {:.4} {:.4} N {:.4} F {:.4} {:?} turn {:.2} T {:.4} {:.4} n {:?} at {:.4} {:.4}",
                                k.obstacle,
                                k.begins_m,
                                k.ends_m,
                                k.normal_n,
                                k.friction_n,
                                k.state,
                                k.turn_deg,
                                k.tension_before_n,
                                k.tension_after_n,
                                k.normal,
                                k.x_m,
                                k.y_m
                            );
                            for q in &k.samples {
                                println!("        {:.4} {:?}", q.arc_length_m, q.force_n);
                            }
                        }
                    }
                }
            }
            break;
        }
        if std::env::var("PROG").is_ok() {
            eprintln!("{:.3} {:?} it {}", s.time_s, t0.elapsed(), s.cost.iterations);
        }
        if s.time_s > end {
            println!("end {most}");
            break;
        }
    }
}

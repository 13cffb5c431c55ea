use furnace::experiment::*;
use std::path::Path;
fn main() {
    let file = std::env::args().nth(1).unwrap();
    let src = std::fs::read_to_string(&file).unwrap();
    let plan = match Plan::new("x", Path::new(&file), &src, &Overrides { filter: std::env::args().nth(2), quick: std::env::var("QUICK").is_ok(), ..Default::default() }) { Ok(p) => p, Err(e) => { eprintln!("{e}"); std::process::exit(2) } };
    let stop = std::sync::atomic::AtomicBool::new(false);
    let mut cells = vec![];
    let t0 = std::time::Instant::now();
    for c in &plan.cells {
        let t = std::time::Instant::now();
        let cell = run_cell(c, &stop, &|_| ());
        let s = t.elapsed().as_secs_f64();
        let k = cell.as_ref().unwrap();
        println!("{:60} n={:9} {:6.2}s {:.2} Mpath/s {:.2} Mrays/s", plan.label(c), c.samples, s, (c.samples*c.pixels) as f64/s/1e6, k.cost.mean*k.cost.n as f64/s/1e6);
        cells.push(cell);
    }
    println!("total {:.1}", t0.elapsed().as_secs_f64());
    for r in verdict::rows(&plan, &cells) {
        if r.verdict.is_some_and(|v| v != furnace::stats::Verdict::Pass) || matches!(r.estimand, Estimand::Mean) {
        println!("{:50} {}{:?} {:?} mean {:.6} truth {:?} se {:?} {:?} mde {:?} eff {:?} {}", plan.label(&plan.cells[r.cell]), r.estimand, r.estimand.index(), r.channel, r.mean, r.truth, r.std_error, r.verdict, r.mde, r.efficiency, r.note);
        }
    }
}

//! Every family of known answers, every integrator and spectral strategy: the quick depth of `tyndall validate`.

use tyndall::validate::{Depth, Outcome, Plan, run};

#[test]
fn known_answers() {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let plan = Plan::new(Depth::Quick, &[], threads).expect("all families");
    let Ok(Outcome::Done(report)) = run(&plan, &()) else { panic!("nobody asked to stop") };
    println!("{}", report.summary_text());
    let failures = report.failures();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    // few rows are too rare for so few samples, and none is skipped unseen
    let rows = report.overall.noisy + report.overall.exact;
    assert!(report.overall.vague * 4 < rows, "{} of {} rows are too rare", report.overall.vague, rows);
    for (family, judged) in &report.families {
        assert!(
            judged.iter().any(|j| j.rows.iter().any(|r| report.passes(r) && r.se > 0.0)),
            "{}",
            family.name
        );
    }
}

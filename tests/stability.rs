//! The stability lab, reduced: every case without a miss, a double hit, a difference from the golden traverser or an overflow.
use lodray::stability::{CASES, Scale, lab};

fn count() -> u64 {
    std::env::var("LODRAY_RAYS").map_or(20_000, |v| v.parse().unwrap())
}

#[test]
fn smoke() {
    for case in CASES {
        let at = std::time::Instant::now();
        let row = lab::run(case, Scale::Small, count(), 1, &|_| ()).unwrap();
        println!("{:<14}{:?} {:.2?}", case.name, row.tally, at.elapsed());
    }
}

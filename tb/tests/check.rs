//! The checks of the testbench notice what they are there for: a right block passes, and each way to be wrong fails with its own words.

use lodray::block::parts::Parts;
use lodray::block::{Block, Form, Timing};
use lodray::num::{S, Vec3};
use tb::{Build, Error, Fault, Mode, Plan, Report, check_block, root, seed};

/// The twin of `tests/rtl/rotate.sv`.
struct Rotate;

impl Block for Rotate {
    const NAME: &'static str = "rotate";
    const TIMING: Timing = Timing::pipelined(3);
    type In = Vec3<32>;
    type Out = Vec3<32>;
    fn parts(_: &Form) -> Parts {
        Parts::default()
    }
    fn eval(i: &Self::In) -> Self::Out {
        Vec3 { x: i.y, y: i.z, z: S::new(!i.x.get()) }
    }
}

fn run(fault: u32, mode: Mode, count: i64) -> Result<Report, Error> {
    let build = Build::with_files("rotate", vec![root().join("tb/tests/rtl/rotate.sv")]).parameter("FAULT", fault);
    let inputs = (0..count).map(|k| Vec3::new(k - 7, 3 * k, -k));
    check_block::<Rotate>(&build, &Plan::new(mode, seed(1)?), inputs)
}

fn fault(number: u32, mode: Mode) -> Fault {
    match run(number, mode, 5000) {
        Err(Error::Failure(failure)) => {
            println!("{failure}");
            failure.fault
        }
        other => panic!("fault {number} was not noticed: {other:?}"),
    }
}

#[test]
fn a_right_block_passes_free_and_stalled() {
    let free = run(0, Mode::Free, 200_000).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((free.transactions, free.min_latency, free.max_latency, free.min_interval), (200_000, 3, 3, 1));
    let stalled = run(0, Mode::Stalled, 200_000).unwrap();
    assert_eq!((stalled.transactions, stalled.min_latency), (200_000, 3));
    assert!(stalled.max_latency > 50 && stalled.cycles > 2 * free.cycles, "{stalled:?}");
}

#[test]
fn nothing_checked_is_an_error() {
    assert!(matches!(run(0, Mode::Free, 0), Err(Error::Nothing(_))));
}

#[test]
fn a_wrong_bit_and_a_wrong_tag() {
    for mode in [Mode::Free, Mode::Stalled] {
        assert!(matches!(fault(1, mode), Fault::Output(_)));
        assert!(matches!(fault(8, mode), Fault::Tag { .. }));
    }
}

#[test]
fn a_lost_input() {
    // The outputs behind it come one place too early.
    assert!(matches!(fault(2, Mode::Free), Fault::Output(_)));
    assert!(matches!(fault(2, Mode::Stalled), Fault::Output(_)));
    assert!(
        matches!(run(2, Mode::Free, 701), Err(Error::Failure(f)) if matches!(f.fault, Fault::Rule(text) if text.contains("no transfer")))
    );
}

#[test]
fn another_latency_and_interval() {
    assert_eq!(fault(4, Mode::Free), Fault::Latency { expected: 3, got: 4 });
    assert_eq!(fault(7, Mode::Free), Fault::Interval { expected: 1, got: 2 });
}

#[test]
fn a_stall_that_costs_more_than_it_must() {
    assert!(matches!(fault(10, Mode::Stalled), Fault::Late { least, got } if got == least + 1));
    assert!(matches!(fault(11, Mode::Stalled), Fault::Refused { inside: 0..3, least: 3 }));
}

#[test]
fn an_output_that_does_not_wait() {
    assert!(matches!(fault(3, Mode::Stalled), Fault::Rule(text) if text.contains("changed")));
    assert!(matches!(fault(5, Mode::Stalled), Fault::Rule(text) if text.contains("fell")));
    assert!(matches!(fault(6, Mode::Stalled), Fault::Rule(text) if text.contains("depends")));
}

#[test]
fn a_failed_assertion() {
    assert!(matches!(fault(9, Mode::Free), Fault::Rule(text) if text.contains("assertion")));
}

#[test]
fn ports_of_other_widths_are_refused() {
    struct Wide;
    impl Block for Wide {
        const NAME: &'static str = "rotate";
        const TIMING: Timing = Timing::pipelined(3);
        type In = Vec3<31>;
        type Out = Vec3<32>;
        fn parts(_: &Form) -> Parts {
            Parts::default()
        }
        fn eval(_: &Self::In) -> Self::Out {
            Vec3::default()
        }
    }
    let build = Build::with_files("rotate", vec![root().join("tb/tests/rtl/rotate.sv")]).parameter("FAULT", 0);
    let result = check_block::<Wide>(&build, &Plan::new(Mode::Free, 1), [Vec3::default()]);
    assert!(result.is_err_and(|e| e.to_string().contains("93")));
}

#[test]
fn without_verilator_a_test_fails_and_says_what_to_run() {
    let this = std::env::current_exe().unwrap();
    let out = std::process::Command::new(this)
        .args(["--exact", "a_right_block_passes_free_and_stalled"])
        .env("LODRAY_VERILATOR", root().join("no/such/verilator"))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&out.stdout);
    assert!(!out.status.success() && text.contains("run scripts/tools"), "{text}");
}

//! The verdict: of documents in which ours wins, a rival wins, none is near enough; in Rust, in the diagram, and as text.

use lodray::report::diagram::diagrams;
use lodray::report::error_time::*;

/// `document` with the costs and errors that `change` gives to its points, compared anew.
fn changed(document: &ErrorTime, change: impl Fn(&mut Point)) -> ErrorTime {
    let mut document = document.clone();
    document.points.iter_mut().for_each(change);
    document.equal_error = equal_errors(&document, "lod");
    document
}

/// Each method with one error for all its settings, in pixels, and one time.
fn made(document: &ErrorTime, of: impl Fn(&Point) -> (f64, f64)) -> ErrorTime {
    changed(document, |point| {
        let (error, time) = of(point);
        point.geometry.surface.as_mut().unwrap().percentile_99 = error;
        point.costs.iter_mut().for_each(|costs| costs.milliseconds = time);
    })
}

fn times(document: &ErrorTime) -> Row {
    let verdict = &verdicts(document)[0];
    verdict.rows.iter().find(|row| row.cost == "time").unwrap().clone()
}

/// `document` has three views, nearest first, with one sample a pixel and with four.
pub fn names_the_winner_ours_or_not(document: &ErrorTime) {
    let near = |method: &str| if method == "lod" { 0.4 } else { 0.1 };
    // Discrete wins near by, ours from afar, and a BVH costs the same as ours between.
    let of = made(document, |p| {
        let time = match (p.view, p.method.as_str()) {
            (0, "discrete") => 1.0,
            (0, _) | (1, "lod" | "bvh") | (2, "lod") => 2.0,
            _ => 6.0,
        };
        (near(&p.method), time)
    });
    let row = times(&of);
    let shown: Vec<_> = row.winners.iter().map(|winner| (winner.best.as_deref(), winner.over_ours)).collect();
    assert_eq!(shown, [(Some("discrete"), Some(0.5)), (None, Some(1.0)), (Some("lod"), Some(3.0))]);
    let verdict = &verdicts(&of)[0];
    assert_eq!(
        verdict.said[0],
        "time, 3 views: discrete in 1, lod in 1, lod and another alike in 1; lod behind by a factor of 2.00; lod ahead by a factor of 3.00"
    );
    assert!(verdict.head.starts_with("160x120: "), "{}", verdict.head);
    let text = verdict_text(&verdicts(&of));
    assert!(text.contains("a, time: 0.7: discrete 0.50, 2: the same 1.00, 6: lod 3.00\n"), "{text}");
    let files = diagrams(&of, &[], &[]).unwrap();
    let map = files.iter().find(|file| file.0 == "winners-haydel2023-free.svg").map(|file| String::from_utf8(file.1.clone()).unwrap());
    for words in [
        "discrete 0.50",
        "the same 1.00",
        "lod 3.00",
        "Winners at 160x120: the cheapest whose surface is within half a pixel (99th percentile)",
    ] {
        assert!(map.as_ref().unwrap().contains(words), "{words}");
    }
    // A rival that is cheaper and not near enough does not win; nor do we.
    let far =
        made(document, |p| if p.method == "discrete" { (0.9, 1.0) } else { (near(&p.method), if p.method == "bvh" { 5.0 } else { 7.0 }) });
    assert!(times(&far).winners.iter().all(|winner| winner.best.as_deref() == Some("bvh") && winner.over_ours == Some(5.0 / 7.0)));
    let further = made(document, |p| (if p.method == "lod" { 0.9 } else { 0.1 }, 1.0));
    let row = times(&further);
    assert!(row.winners.iter().all(|w| w.best.is_some() && w.over_ours.is_none() && w.note == Some("ours is further off")), "{row:?}");
    let alone = made(document, |p| (if p.method == "lod" { 0.1 } else { 0.9 }, 1.0));
    assert!(
        times(&alone)
            .winners
            .iter()
            .all(|winner| winner.best.as_deref() == Some("lod") && winner.note == Some("all others are further off"))
    );
    let none = made(document, |_| (0.9, 1.0));
    assert!(times(&none).winners.iter().all(|winner| winner.best.is_none()));
    assert!(verdicts(&none)[0].said[0].starts_with("time, 3 views: none in 3"));
    // Without rivals there is no verdict.
    let mut lonely = document.clone();
    lonely.methods.retain(|method| method.name == "lod");
    lonely.equal_error = equal_errors(&lonely, "lod");
    assert!(verdicts(&lonely).is_empty() && verdict_text(&[]).is_empty());
}

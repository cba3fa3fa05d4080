//! Frames after one another.

use super::*;

/// Frames, each a chunk.
fn run_frames(machine: &Machine, frames: &[Chunk], threads: usize) -> Run {
    let chunks = frames.iter().enumerate().map(|(at, frame)| if at > 0 { frame.clone().beginning_frame() } else { frame.clone() });
    run_free(machine, nodes(), chunks, Running { window: None, threads }).unwrap()
}

#[test]
fn a_frame_waits_for_the_last_ray_of_the_one_before_and_finds_its_lines() {
    let machine = machine(&[]);
    let lines = vec![vec![5, 6, 7], vec![8]];
    let cold = run(&machine, &lines);
    let two = run_frames(&machine, &[rays(&lines), rays(&lines), rays(&[vec![5, 9]])], 1);
    let [first, second, third] = two.frames.as_slice() else { panic!("{:?}", two.frames) };
    assert_eq!((first.start, first.end.end, first.end.counts.rays), (0, cold.cycles, 2));
    assert_eq!((second.end.counts.rays, third.end.counts.rays), (4, 5));
    // As long after the last ray as a group waits for rays that it asks for.
    let gap = second.start - first.end.end;
    assert!(gap >= 1 && third.start - second.end.end == gap);
    // All is in the L1.
    assert_eq!(second.end.end - second.start, 4 * u64::from(machine.l1.latency_cycles));
    assert_eq!(second.end.counts.l1.misses, first.end.counts.l1.misses);
    // But for a line that nobody read before.
    assert_eq!(third.end.counts.l1.misses, second.end.counts.l1.misses + 1);
    assert_eq!((two.cycles, two.counts), (third.end.end, third.end.counts));
    assert!(third.end.dram.read_pj > second.end.dram.read_pj && second.end.dram.read_pj == first.end.dram.read_pj);
}

#[test]
fn one_frame_is_the_whole_run_and_threads_change_nothing() {
    let machine = machine(&[("cores.groups", 8), ("cores.per_group", 4)]);
    let mut random = Random::new(3);
    let mut frame = || {
        let mut ray = || (0..random.below(12)).map(|_| random.below(4000) as u32).collect::<Vec<_>>();
        (0..6).flat_map(|_| [rays(&[ray(), ray(), ray(), ray(), ray(), ray()])]).collect::<Vec<_>>()
    };
    // Each of several chunks, of which the first begins it.
    let frames: Vec<_> = (0..4).map(|_| frame()).collect();
    let chunks = |frames: &[Vec<Chunk>]| {
        let begin = |(at, frame): (usize, &Vec<Chunk>)| {
            let mut frame = frame.clone();
            if at > 0 {
                frame[0] = frame[0].clone().beginning_frame();
            }
            frame
        };
        frames.iter().enumerate().flat_map(begin).collect::<Vec<_>>()
    };
    let run = |frames: &[Vec<Chunk>], threads| {
        run_free(&machine, nodes(), chunks(frames).into_iter(), Running { window: None, threads }).unwrap()
    };
    let all = run(&frames, 1);
    assert_eq!(all.frames.len(), 4);
    for threads in [2, 3, 8] {
        assert_eq!(run(&frames, threads), all, "{threads} threads");
    }
    // The first frames of a run are those of a run that ends there.
    for count in 1..4 {
        let fewer = run(&frames[..count], 1);
        assert_eq!((&fewer.frames[..], fewer.cycles), (&all.frames[..count], all.frames[count - 1].end.end));
    }
    for frame in &all.frames {
        assert!(frame.start <= frame.half && frame.half <= frame.end.end);
    }
}

#[test]
fn stragglers_begin_when_fewer_than_half_of_the_contexts_have_rays() {
    // Four cores, two of which have one more line to wait for, and one of these another.
    let machine = machine(&[("cores.per_group", 4)]);
    let frame = [vec![1], vec![1], vec![1, 2], vec![1, 2, 3]];
    let run = run(&machine, &frame);
    let [only] = run.frames.as_slice() else { panic!() };
    let three = super::run(&machine, &frame[..3]).cycles;
    assert_eq!((only.half, only.end.end), (three, run.cycles));
    // Fewer rays than that in all: from the start.
    let few = super::run(&machine, &[vec![1]]);
    assert_eq!(few.frames[0].half, 0);
}

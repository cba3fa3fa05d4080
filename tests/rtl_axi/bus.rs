//! An AXI read bus: its ports at a top, and a memory behind it that answers when and in the order it likes.

use lodray::num::{U, Wire};
use lodray_test_support::models::Rng;
use std::collections::VecDeque;
use tb::{Direction, PortId, Sim};

/// A read request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    pub id: u64,
    pub address: u64,
    pub len: u64,
    pub size: u64,
}

/// A beat of `N` words of 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct Beat<const N: usize> {
    pub id: u64,
    pub data: [U<32>; N],
    pub resp: u64,
    pub last: bool,
}

/// The ports of a bus of `N` words of 32 bits, ids of `ID` and addresses of `A` bits.
pub struct Bus<const N: usize, const ID: u32, const A: u32> {
    request: [PortId; 5],
    ready: PortId,
    beat: [PortId; 5],
    takes: PortId,
}

impl<const N: usize, const ID: u32, const A: u32> Bus<N, ID, A> {
    /// The size of a full beat, as AXI has it.
    pub const SIZE: u64 = 2 + N.ilog2() as u64;
    /// Beats of a line.
    pub const BEATS: u64 = 8 / N as u64;

    pub fn new(sim: &Sim) -> Self {
        let port = |name: &str, width, direction| sim.port(&format!("axi_{name}"), width, direction).unwrap_or_else(|e| panic!("{e}"));
        let output = |name: &str, width| port(name, width, Direction::Out);
        let input = |name: &str, width| port(name, width, Direction::In);
        Self {
            request: [("arvalid_o", 1), ("arid_o", ID), ("araddr_o", A), ("arlen_o", 8), ("arsize_o", 3)].map(|(name, w)| output(name, w)),
            ready: input("arready_i", 1),
            beat: [("rvalid_i", 1), ("rid_i", ID), ("rdata_i", 32 * N as u32), ("rresp_i", 2), ("rlast_i", 1)]
                .map(|(name, w)| input(name, w)),
            takes: output("rready_o", 1),
        }
    }

    /// What the memory offers in this cycle; where it offers nothing, anything stands at the port.
    pub fn drive(&self, sim: &mut Sim, ready: bool, beat: Option<Beat<N>>, rng: &mut Rng) {
        let [valid, id, data, resp, last] = self.beat;
        let [any, more] = [(); 2].map(|()| rng.draw());
        let shown = beat.unwrap_or_else(|| Beat { id: any, data: [U::new(more >> 32); N], resp: any >> 60, last: any >> 50 & 1 == 1 });
        sim.poke(self.ready, &ready);
        sim.poke(valid, &beat.is_some());
        sim.poke(id, &U::<ID>::new(shown.id & U::<ID>::MAX.get()));
        sim.poke(data, &shown.data);
        sim.poke(resp, &U::<2>::new(shown.resp & 3));
        sim.poke(last, &shown.last);
    }

    /// What is asked for in this cycle. Beats are always taken.
    pub fn request(&self, sim: &mut Sim) -> Option<Request> {
        let [valid, id, address, len, size] = self.request;
        assert!(sim.peek::<bool>(self.takes), "a beat would not be taken");
        sim.peek::<bool>(valid).then(|| Request {
            id: sim.peek::<U<ID>>(id).get(),
            address: sim.peek::<U<A>>(address).get(),
            len: sim.peek::<U<8>>(len).get(),
            size: sim.peek::<U<3>>(size).get(),
        })
    }
}

/// How a memory behaves.
#[derive(Clone, Copy, Debug)]
pub struct Manners {
    /// Of eight cycles those in which it takes no request, and in which it gives no beat.
    pub refuses: u64,
    pub rests: u64,
    /// Cycles from a request to its first beat: at least so many, at most so many.
    pub latency: (u64, u64),
    /// Beats of one read come between those of another; else a read is finished once it is begun.
    pub interleaves: bool,
    /// One beat in so many has an error; none if 0.
    pub errors: u64,
}

/// No stalls and no errors, requests answered in their order.
pub const SMOOTH: Manners = Manners { refuses: 0, rests: 0, latency: (1, 1), interleaves: false, errors: 0 };

/// A read under way.
struct Read {
    request: Request,
    from: u64,
    sent: u64,
    wrong: bool,
}

/// A memory of words.
pub struct Memory<F> {
    word: F,
    manners: Manners,
    pub rng: Rng,
    cycle: u64,
    reads: Vec<Read>,
    /// The addresses of reads whose last beat was given, and whether any beat had an error.
    pub finished: VecDeque<(u64, bool)>,
    /// Most reads under way, and beats that came between those of another read.
    pub most: usize,
    pub between: u64,
    before: Option<u64>,
}

impl<F: Fn(u64) -> u32> Memory<F> {
    pub fn new(manners: Manners, seed: u64, word: F) -> Self {
        let (reads, finished) = (Vec::new(), VecDeque::new());
        Self { word, manners, rng: Rng(seed), cycle: 0, reads, finished, most: 0, between: 0, before: None }
    }

    /// Whether it takes a request in this cycle.
    pub fn ready(&mut self) -> bool {
        self.rng.below(8) >= self.manners.refuses
    }

    /// The beat of this cycle.
    pub fn beat<const N: usize>(&mut self) -> Option<Beat<N>> {
        self.cycle += 1;
        if self.rng.below(8) < self.manners.rests {
            return None;
        }
        let due: Vec<usize> = (0..self.reads.len()).filter(|&k| self.reads[k].from <= self.cycle).collect();
        let begun = due.iter().copied().find(|&k| self.reads[k].sent > 0).filter(|_| !self.manners.interleaves);
        let first = due.first().copied().filter(|_| self.manners.latency.0 == self.manners.latency.1);
        let k = begun.or(first.filter(|_| !self.manners.interleaves)).or_else(|| match due.len() as u64 {
            0 => None,
            n => Some(due[self.rng.below(n) as usize]),
        })?;
        let error = self.manners.errors > 0 && self.rng.below(self.manners.errors) == 0;
        let read = &mut self.reads[k];
        let (id, at) = (read.request.id, read.request.address + read.sent * 4 * N as u64);
        let data = std::array::from_fn(|j| U::new(u64::from((self.word)(at + 4 * j as u64))));
        self.between += u64::from(read.sent > 0 && self.before != Some(id));
        read.wrong |= error;
        read.sent += 1;
        let last = read.sent == read.request.len + 1;
        self.before = Some(id).filter(|_| !last);
        if last {
            let read = self.reads.remove(k);
            self.finished.push_back((read.request.address, read.wrong));
        }
        // SLVERR, DECERR, and EXOKAY, which answers nothing that was asked.
        let resp = if error { 1 + self.rng.below(3) } else { 0 };
        Some(Beat { id, data, resp, last })
    }

    /// A reset.
    pub fn forget(&mut self) {
        self.reads.clear();
        self.finished.clear();
        self.before = None;
    }

    /// A request taken.
    pub fn take(&mut self, request: Request) {
        let (low, high) = self.manners.latency;
        let from = self.cycle + low + self.rng.below(high - low + 1);
        self.reads.push(Read { request, from, sent: 0, wrong: false });
        self.most = self.most.max(self.reads.len());
    }
}

/// An input of a top.
pub fn input<T: Wire>(sim: &Sim, name: &str) -> PortId {
    sim.port(name, T::WIDTH, Direction::In).unwrap_or_else(|error| panic!("{error}"))
}

/// An output.
pub fn output<T: Wire>(sim: &Sim, name: &str) -> PortId {
    sim.port(name, T::WIDTH, Direction::Out).unwrap_or_else(|error| panic!("{error}"))
}

//! Who asks for what, and whose turn it is.

use super::ports::Steps;
use super::unit::UnitTiming;
use crate::hardware::{Resource, State};

impl<R: Steps> UnitTiming<R> {
    /// Context `who` asks for what its state needs, from cycle `now` on.
    #[inline]
    pub(super) fn ask(&mut self, who: usize, now: u64) {
        let context = &self.contexts[who];
        let resource = match context.state {
            State::Setup => Resource::Setup,
            State::Fetch => Resource::Fetch,
            State::Child => Resource::Child,
            State::Decide => Resource::Decide,
            State::Lod => Resource::Lod,
            State::Morph => Resource::Morph,
            State::Tri => Resource::Tri,
            State::DivideV => Resource::Divide,
            State::Map => Resource::Map,
            State::Done => Resource::Hit,
            state => unreachable!("nobody wakes in {state:?}"),
        };
        if resource != Resource::Fetch || context.want > 0 {
            self.ask_for(resource, who, now);
        }
    }

    #[inline(always)]
    pub(super) fn ask_for(&mut self, resource: Resource, who: usize, now: u64) {
        let asking = &mut self.asking[resource as usize];
        if *asking == 0 {
            self.since[resource as usize] = now;
            self.asked |= 1 << resource as usize;
        }
        *asking |= 1 << who;
    }

    /// `resource` takes the request of the context whose turn it is.
    #[inline]
    pub(super) fn grant(&mut self, resource: Resource, now: u64) {
        let at = resource as usize;
        let who = self.arbiters[at].winner(self.asking[at]).expect("somebody asks");
        self.arbiters[at].took(who);
        let since = self.since[at];
        let again = match resource {
            Resource::Fetch => {
                let (request, more) = self.fetch(who, now);
                self.requests.push_back((now, request));
                self.stations[at].enter(since, now);
                more
            }
            Resource::Hit => {
                self.hit = Some(self.finish(who, now));
                false
            }
            _ => self.granted(resource, who, since, now),
        };
        if !again {
            self.asking[at] &= !(1 << who);
            if self.asking[at] == 0 {
                self.asked &= !(1 << at);
            }
        }
    }

    /// The division serves the hit queue; whether it would take another hit in this cycle.
    pub(super) fn divide_hit(&mut self, now: u64) -> bool {
        let divide = &mut self.stations[Resource::Divide as usize];
        if divide.free() > now {
            return false;
        }
        if let Some((since, who)) = self.hits.pop(now) {
            // Contexts that ask meanwhile wait too, perhaps longer than the hit.
            let asked = self.asking[Resource::Divide as usize] != 0;
            let since = if asked { since.min(self.since[Resource::Divide as usize]) } else { since };
            let divided = divide.take(since, now);
            let selected = self.select.take(divided, divided);
            self.selected(who, selected, now);
            return self.stations[Resource::Divide as usize].is_eased();
        }
        false
    }
}

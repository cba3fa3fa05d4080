//! What a unit is doing, for error messages.

use super::context::ContextTiming;
use super::unit::UnitTiming;

impl<R> UnitTiming<R> {
    /// No context holds a ray.
    pub fn is_idle(&self) -> bool {
        self.contexts.iter().all(|context| context.ray.is_none())
    }

    /// The state of every context that holds a ray, and what it waits for.
    pub fn describe(&self) -> String {
        let busy = self.contexts.iter().enumerate().filter(|(_, context)| context.ray.is_some());
        let line = |(k, context): (usize, &ContextTiming<R>)| {
            let [state, owed] = [context.state.name().to_owned(), (context.owed + context.later.owed).to_string()];
            format!("context {k}: {state} since {}, {owed} results or lines owed", context.entered)
        };
        busy.map(line).collect::<Vec<_>>().join("; ")
    }
}

//! What took how long, as a line of the file beside a shard's: apart from results, which are the same however long they took.

use super::part::Spent;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// A line: of a job or of a scene's opening.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Took {
    /// Name of the job.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// Name of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opened: Option<String>,
    pub seconds: f64,
}

impl Took {
    pub fn new(what: Spent<'_>, time: Duration) -> Self {
        let (key, opened) = match what {
            Spent::Job(key) => (Some(key.to_owned()), None),
            Spent::Opening(scene) => (None, Some(scene.to_owned())),
        };
        Self { key, opened, seconds: time.as_secs_f64() }
    }
}

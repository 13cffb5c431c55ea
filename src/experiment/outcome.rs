//! What a study has found, as stored in `study.json`.

use super::error::Error;
use super::plan::Plan;
use super::study::Detection;
use crate::stats::nulls::NullRow;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What runs and synthetic laws have shown.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Outcome {
    /// Of each cell, in the plan's order; `None` where the study was interrupted.
    pub detections: Vec<Option<Detection>>,
    /// Lines of the tables of laws.
    pub nulls: Vec<NullRow>,
    /// Whether all of it is there.
    pub whole: bool,
}

impl Outcome {
    /// Reads the bytes of `file`.
    ///
    /// # Errors
    ///
    /// When it is damaged, or of other cells than those of `plan`.
    pub fn parse(file: &Path, text: &[u8], plan: &Plan) -> Result<Self, Error> {
        let refused = |why: String| Error::Refused(format!("{} {why}", file.display()));
        let outcome: Outcome =
            serde_json::from_slice(text).map_err(|e| refused(format!("is damaged: {e}")))?;
        if !outcome.detections.iter().flatten().all(Detection::is_whole) {
            return Err(refused("is damaged: lists are too short, or counts too large".to_owned()));
        }
        if outcome.detections.len() != plan.cells.len() {
            return Err(refused("holds other cells than are planned now; run the study again".to_owned()));
        }
        Ok(outcome)
    }
}

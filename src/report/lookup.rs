//! Finding rows.

use crate::experiment::{Estimand, Plan, Row};
use crate::stats::Verdict;

/// The rows of a run, by cell.
pub struct Lookup<'a> {
    /// The plan.
    pub plan: &'a Plan,
    rows: &'a [Row],
    by_cell: Vec<Vec<&'a Row>>,
}

impl<'a> Lookup<'a> {
    /// Sorts the rows by cell.
    pub fn new(plan: &'a Plan, rows: &'a [Row]) -> Self {
        let mut by_cell = vec![Vec::new(); plan.cells.len()];
        rows.iter().for_each(|row| by_cell[row.cell].push(row));
        Lookup { plan, rows, by_cell }
    }

    /// The rows of a cell; none if it was not finished.
    pub fn cell(&self, cell: usize) -> &[&'a Row] {
        &self.by_cell[cell]
    }

    /// All rows.
    pub fn rows(&self) -> &'a [Row] {
        self.rows
    }

    /// One row.
    pub fn row(&self, cell: usize, estimand: Estimand, channel: Option<usize>) -> Option<&'a Row> {
        self.cell(cell).iter().find(|r| r.estimand == estimand && r.channel == channel).copied()
    }

    /// The worst verdict of a cell; `None` if its mean was not judged: that some bounces pass is not enough.
    pub fn verdict(&self, cell: usize) -> Option<Verdict> {
        let about_mean = |row: &&&Row| matches!(row.estimand, Estimand::Mean | Estimand::Agree);
        let mean = self.cell(cell).iter().filter(about_mean).filter_map(|row| row.verdict).max();
        let worst = self.cell(cell).iter().filter_map(|row| row.verdict).max();
        worst.filter(|&worst| mean.is_some() || worst != Verdict::Pass)
    }

    /// Whether the cell runs an estimator with a known mistake.
    pub fn is_faulty(&self, cell: usize) -> bool {
        self.plan.cells[cell].fault.is_some()
    }

    /// Whether the cell has an image.
    pub fn is_image(&self, cell: usize) -> bool {
        self.plan.cells[cell].pixels > 1
    }

    /// What theory expects a cell to leave out, relative to the truth, in the channels that have light.
    pub fn expected_shares(&self, cell: usize) -> Vec<f64> {
        let rows = (0..3).filter_map(|c| self.row(cell, Estimand::Mean, Some(c)));
        rows.filter_map(|r| Some(r.expected_bias? / r.truth.filter(|&truth| truth != 0.0)?)).collect()
    }

    /// Whether a cell's mean should be the right value: no clamp cuts light there, and there is a way to all of it.
    pub fn finds_all(&self, cell: usize) -> bool {
        let shares = self.expected_shares(cell);
        match shares.is_empty() {
            true => self.plan.cells[cell].is_unbiased(),
            false => shares.iter().all(|share| share.abs() < 1e-9),
        }
    }

    /// Whether all samples of a cell are alike.
    pub fn is_noise_free(&self, cell: usize) -> bool {
        let steady =
            |c| self.row(cell, Estimand::Mean, Some(c)).is_some_and(|r| r.note.starts_with("noise-free"));
        (0..3).all(steady)
    }

    /// Indices of the finished cells of a scene.
    pub fn of_scene(&self, scene: &str) -> Vec<usize> {
        let cells = 0..self.plan.cells.len();
        cells.filter(|&i| self.plan.cells[i].scene_label == scene && !self.cell(i).is_empty()).collect()
    }

    /// The scenes in their order.
    pub fn scenes(&self) -> Vec<&'a str> {
        let mut scenes: Vec<&str> = Vec::new();
        for cell in &self.plan.cells {
            if !scenes.contains(&cell.scene_label.as_str()) {
                scenes.push(&cell.scene_label);
            }
        }
        scenes
    }

    /// 1 / (rays x sum over channels of the variance), with its standard error: for images by the variance of a pixel
    /// (its median over the image, or its mean), else by that of a realization.
    pub fn efficiency(&self, cell: usize, estimand: Estimand) -> Option<(f64, Option<f64>)> {
        let rows: Vec<&Row> = (0..3).map(|c| self.row(cell, estimand, Some(c))).collect::<Option<_>>()?;
        let variance: f64 = rows.iter().map(|r| r.variance).sum::<Option<f64>>()?;
        let rays = rows[0].rays?;
        let value = 1.0 / (variance * rays);
        // channels share their paths: errors add up, at worst
        let error: Option<f64> =
            rows.iter().map(|r| Some(r.variance? * r.efficiency_error? / r.efficiency?)).sum::<Option<f64>>();
        value.is_finite().then(|| (value, error.map(|e| value * e / variance)))
    }
}

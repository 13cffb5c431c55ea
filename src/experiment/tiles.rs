//! What is measured of a cell's image: its tiles, and the variance of its pixels.

use super::cell::TILES;
use super::row::Estimand;
use super::spec::Claim;
use super::subject::Subject;
use super::verdict::Sheet;
use crate::stats::Question;
use crate::truth::Counted;

impl Subject<'_> {
    /// Tiles and the variance of pixels.
    pub fn image(&self, sheet: &mut Sheet<'_>) {
        let variance = &self.cell.pixel_variance;
        if variance[0].n == 0 {
            return;
        }
        let rays = self.cell.cost.mean / self.plan.pixels as f64;
        for (channel, moments) in variance.iter().enumerate() {
            let mut row = self.row(Estimand::PixelVariance, Some(channel), moments.mean);
            row.std_error = moments.std_error();
            row.variance = Some(moments.mean);
            row.rays = Some(rays);
            row.rate(moments.std_error());
            sheet.state(row);
            let mut row =
                self.row(Estimand::MedianPixelVariance, Some(channel), self.cell.median_variance[channel]);
            row.variance = Some(row.mean);
            row.rays = Some(rays);
            row.rate(None);
            sheet.state(row);
        }
        (0..self.cell.tiles.len()).for_each(|tile| self.tile(tile, sheet));
    }

    fn tile(&self, tile: usize, sheet: &mut Sheet<'_>) {
        let tiles = TILES as usize;
        let claim = sheet.claim(Claim::tiles).filter(|_| self.plan.is_unbiased());
        for channel in 0..3 {
            let image = self.truth.mean(channel, Counted::All);
            let right = self.truth.tile(tile % tiles, tile / tiles, tiles, channel);
            let (Some(image), Some(right)) = (image, right) else { return };
            let measured = self.cell.tiles[tile][channel];
            let mut row = self.row(Estimand::Tile(tile), Some(channel), measured.mean);
            row.std_error = Some(measured.std_error);
            row.against(&right, self.plan.is_unbiased().then_some(right.value));
            sheet.state(row);
            if let Some((claim, margin)) = claim {
                let margin = margin * right.value.max(image.value);
                let question = Question {
                    mean: measured.mean,
                    std_error: measured.std_error,
                    expected_std_error: right.std_error,
                    expected_df: right.df,
                    systematic: right.bound + self.plan.core.rounding() * right.value.abs(),
                    ..Question::about(&self.cell.total[channel], self.cell.invalid(), right.value, margin)
                };
                sheet.ask(claim, question);
            }
        }
    }
}

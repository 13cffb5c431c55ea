//! Sizes of text and lines: on a screen, and in a paper.

use super::Figure;

/// How large things are drawn, in pixels of a figure; in print, a pixel is a twelfth of the font size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    /// Width of the figure. `None`: what its panels need.
    width: Option<f64>,
    /// Whether the figure shows its title; in a paper, captions do.
    pub titled: bool,
    /// Font sizes: of the title of a panel, the labels of axes and of ticks, the legend, the footnote.
    pub panel: f64,
    pub label: f64,
    pub tick: f64,
    pub legend: f64,
    pub note: f64,
    /// Space around the figure.
    pub margin: f64,
    /// Thickness of lines and size of markers, relative to those on a screen.
    pub weight: f64,
}

/// Space between panels.
pub(super) const BETWEEN: f64 = 14.0;

/// Font size in print, in which all text there is set.
pub(super) const PRINT_EM: f64 = 12.0;

/// Panels narrower than this are put below one another in print; with categories, and without.
const NARROWEST: (f64, f64) = (300.0, 190.0);

/// Panels in a row, width of the figure, and height of plots.
pub(super) struct Arrangement {
    pub columns: usize,
    pub width: f64,
    pub height: f64,
}

impl Look {
    pub const SCREEN: Self = Self {
        width: None,
        titled: true,
        panel: 14.0,
        label: 13.0,
        tick: 12.0,
        legend: 12.5,
        note: 11.5,
        margin: 14.0,
        weight: 1.0,
    };

    /// For a column of this width.
    pub fn print(width: f64) -> Self {
        Self {
            width: Some(width),
            titled: false,
            panel: PRINT_EM,
            label: PRINT_EM,
            tick: PRINT_EM,
            legend: PRINT_EM,
            note: PRINT_EM,
            margin: 2.0,
            weight: 0.75,
        }
    }

    /// Where the panels of a figure go.
    pub fn arrange(&self, figure: &Figure) -> Arrangement {
        let columns = figure.columns.clamp(1, figure.panels.len().max(1));
        let Some(width) = self.width else {
            let (width, height) = match columns {
                1 => (780.0, 360.0),
                2 => (1060.0, 320.0),
                more => (60.0 + 390.0 * more as f64, 290.0),
            };
            return Arrangement { columns, width, height };
        };
        let named = figure.panels.iter().any(|panel| !panel.x.categories.is_empty());
        let narrowest = if named { NARROWEST.0 } else { NARROWEST.1 };
        let inner = width - 2.0 * self.margin + BETWEEN;
        let columns = columns.min((inner / (narrowest + BETWEEN)) as usize).max(1);
        let height = (0.5 * (inner / columns as f64 - BETWEEN)).clamp(130.0, 230.0);
        Arrangement { columns, width, height }
    }
}

impl Default for Look {
    fn default() -> Self {
        Self::SCREEN
    }
}

//! How photons count by their distance, and which of them are gathered.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Weight of a photon by its distance d from the point that is looked at, within the radius r.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kernel {
    /// 1: all alike.
    #[default]
    Box,
    /// 1 - d / (c r) [Jensen 1996].
    Cone {
        /// c >= 1; 1 brings the weight down to 0 at the rim.
        #[schemars(range(min = 1))]
        c: f64,
    },
    /// 1 - d² / r² [Epanechnikov 1969; Silverman 1986, sec. 4.2].
    Epanechnikov,
}

impl Kernel {
    /// The weight at `t` = d² / r² in [0, 1], of mean 1 over the disk.
    #[inline]
    pub fn weight(self, t: f64) -> f64 {
        match self {
            Kernel::Box => 1.0,
            Kernel::Cone { c } => (1.0 - t.sqrt() / c) / (1.0 - 2.0 / (3.0 * c)),
            Kernel::Epanechnikov => 2.0 * (1.0 - t),
        }
    }
}

/// Which photons are gathered around a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gather {
    /// The k nearest; r is the distance of the last of them.
    Nearest {
        /// k >= 2.
        k: u32,
        /// Whether the last one counts.
        last: Last,
    },
    /// All within r.
    Within {
        /// r > 0 [scene units].
        radius: f64,
    },
    /// All within an r that shrinks from map to map, r²_{i+1} = r²_i (i + alpha) / (i + 1)
    /// [Hachisuka et al. 2008; Knaus & Zwicker 2011, eq. 15].
    Shrinking {
        /// r of the first map > 0 [scene units].
        radius: f64,
        /// Share of new photons that are kept, in (0, 1).
        alpha: f64,
        /// So many maps make one picture; then the next picture starts.
        passes: u64,
    },
}

/// Whether the k-th of the k nearest photons counts, by which their radius is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Last {
    /// k photons within the distance of the k-th: too bright by k / (k - 1) [García et al. 2012].
    #[default]
    Counted,
    /// k - 1 photons: right where light is uniform.
    LeftOut,
}

/// How the error of a mean falls with the number n of realizations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// The variance falls as n to the power -variance.
    pub variance: f64,
    /// The bias falls as n to the power -bias; 0 if it stays.
    pub bias: f64,
}

impl Gather {
    /// How the error falls with the number of maps [Knaus & Zwicker 2011, sec. 4.2].
    pub fn rates(self) -> Rates {
        match self {
            Gather::Nearest { .. } | Gather::Within { .. } => Rates { variance: 1.0, bias: 0.0 },
            Gather::Shrinking { alpha, .. } => Rates { variance: alpha, bias: 1.0 - alpha },
        }
    }

    /// The radius of the map of this realization; none if the photons themselves decide.
    pub fn radius(self, realization: u64) -> Option<f64> {
        match self {
            Gather::Nearest { .. } => None,
            Gather::Within { radius } => Some(radius),
            Gather::Shrinking { radius, alpha, passes } => {
                let shrunk = |i: u64| (i as f64 + alpha) / (i as f64 + 1.0);
                let squared: f64 = (1..=realization % passes).map(shrunk).product();
                Some(radius * squared.sqrt())
            }
        }
    }
}

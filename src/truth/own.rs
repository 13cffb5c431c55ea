//! References that this program makes itself, by Monte Carlo: never the truth for an estimator of the kind that made
//! them, as both would share its mistakes.

use super::layers::{BadReference, Layers};
use super::reference::{Reference, root};
use crate::estimator::{Estimate, Estimator, Property};
use crate::scene::Rgb;
use crate::scene::library::SceneKind;
use serde::{Deserialize, Serialize};

/// Version of the file: raised whenever the same words would no longer lead to the same bits.
pub const FORMAT: u32 = 1;

/// More realizations than this nobody can have taken.
const MOST: u64 = 1 << 53;

/// All that a stored reference follows from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// See [`FORMAT`].
    pub format: u32,
    /// Version of the program that wrote it last.
    pub version: String,
    /// The scene.
    pub scene: SceneKind,
    /// What sampled it.
    pub estimator: Estimator,
    /// The seed.
    pub seed: u64,
    /// Realizations so far, numbered from 0.
    pub samples: u64,
}

impl Provenance {
    /// What is not yet sampled.
    pub fn new(scene: &SceneKind, estimator: &Estimator, seed: u64) -> Self {
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Provenance { format: FORMAT, version, scene: scene.clone(), estimator: *estimator, seed, samples: 0 }
    }

    /// In what two references differ that do not belong together, theirs first; the number of samples and the
    /// program's version may differ.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let told = |what: &str, a: String, b: String| (a != b).then(|| format!("{what} {a}, not {b}"));
        told("the format", self.format.to_string(), other.format.to_string())
            .or_else(|| told("the scene", json(&self.scene), json(&other.scene)))
            .or_else(|| told("the estimator", json(&self.estimator), json(&other.estimator)))
            .or_else(|| told("the seed", self.seed.to_string(), other.seed.to_string()))
    }
}

fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("plain numbers and names have a JSON form")
}

/// What estimators are called that share their mistakes: those that sample lights, and those that wait for chance,
/// be it with one walk or with many.
pub fn kind(estimator: &Estimator) -> &'static str {
    match estimator {
        Estimator::LightTracing(_) => "light_tracing",
        Estimator::PhotonMap(_) => "photon_map",
        _ if estimator.samples_lights() => "explicit",
        _ => "implicit",
    }
}

/// A reference of our own, with the state that further samples can be added to.
#[derive(Clone, Debug, PartialEq)]
pub struct Own {
    /// What it follows from.
    pub provenance: Provenance,
    /// Pixels along each edge; 1 for a probe.
    pub size: usize,
    /// Mean of each pixel, row by row from the top left [W m^-2 sr^-1].
    pub mean: Vec<Rgb>,
    /// Sum of squared deviations of each pixel's samples.
    pub m2: Vec<Rgb>,
}

impl Own {
    /// Reads a file that [`Own::bytes`] wrote.
    pub fn read(bytes: &[u8]) -> Result<Self, BadReference> {
        Own::from_layers(&Layers::read(bytes)?)
    }

    pub(super) fn from_layers(layers: &Layers) -> Result<Self, BadReference> {
        let bad = |why: String| BadReference::Provenance(why);
        let text = layers.provenance.as_deref().ok_or_else(|| bad("it says nothing".to_owned()))?;
        let value: serde_json::Value = serde_json::from_str(text).map_err(|e| bad(e.to_string()))?;
        if value["format"] != FORMAT {
            return Err(bad(format!("its format is {}, not {FORMAT}", value["format"])));
        }
        let provenance: Provenance = serde_json::from_value(value).map_err(|e| bad(e.to_string()))?;
        if !(2..=MOST).contains(&provenance.samples) {
            let why = format!("{} samples; they lie in 2 to {MOST}", provenance.samples);
            return Err(bad(why));
        }
        if provenance.estimator.property() != Property::Unbiased {
            return Err(bad("its estimator is biased".to_owned()));
        }
        // a NaN would be in these, too, and they can say where
        let (seen, scatter) = (layers.rgb("")?, layers.rgb("variance.")?);
        let (mean, m2) = (layers.exact("state.mean.")?, layers.exact("state.m2.")?);
        let degrees = (provenance.samples - 1) as f64;
        let is_of = |exact: Rgb, shown: Rgb| (0..3).all(|c| f64::from(exact[c] as f32) == shown[c]);
        let pairs = mean.iter().zip(&seen).zip(m2.iter().zip(&scatter));
        if pairs.into_iter().any(|((&m, &s), (&m2, &v))| !is_of(m, s) || !is_of(m2 / degrees, v)) {
            return Err(bad("its state is not that of its picture".to_owned()));
        }
        Ok(Own { provenance, size: layers.width, mean, m2 })
    }

    /// The file: `R G B`, `variance.*` of one sample and `samples` to look at, `state.*` to go on from, bit by bit.
    pub fn bytes(&self) -> Result<Vec<u8>, exr::error::Error> {
        let mut layers = Layers::new(self.size, self.size);
        layers.provenance = Some(json(&self.provenance));
        layers.add_rgb("", &self.mean);
        let degrees = (self.provenance.samples - 1) as f64;
        let variance: Vec<Rgb> = self.m2.iter().map(|&m2| m2 / degrees).collect();
        layers.add_rgb("variance.", &variance);
        layers.add("samples", vec![self.provenance.samples as f32; self.mean.len()]);
        layers.add_exact("state.mean.", &self.mean);
        layers.add_exact("state.m2.", &self.m2);
        layers.bytes()
    }

    /// Means and standard errors; pixels and realizations are independent.
    pub fn reference(self) -> Result<Reference, BadReference> {
        if self.m2.iter().all(|&m2| m2 == Rgb::ZERO) {
            return Err(BadReference::NoVariance);
        }
        let n = self.provenance.samples as f64;
        let std_error = self.m2.iter().map(|&m2| root(m2 / ((n - 1.0) * n))).collect();
        let (size, mean, provenance) = (self.size, self.mean, Some(self.provenance));
        Ok(Reference { size, mean, std_error, df: n - 1.0, systematic: 0.0, provenance })
    }

    /// Standard error of the image's mean relative to it, worst channel; a channel without light counts as exact,
    /// unless none has any.
    pub fn relative_error(&self) -> f64 {
        let n = self.provenance.samples as f64;
        let (mean, m2) = (self.mean.iter().sum::<Rgb>(), self.m2.iter().sum::<Rgb>());
        if mean == Rgb::ZERO || n < 2.0 {
            return f64::INFINITY;
        }
        let error = root(m2 / ((n - 1.0) * n));
        (0..3).filter(|&c| mean[c] > 0.0).map(|c| error[c] / mean[c]).fold(0.0, f64::max)
    }
}

//! Reading what a user wrote: each wrong value is refused where it stands, with what would be right.

mod scene;
pub mod schema;

pub use scene::*;

use super::bounds;
use crate::scene::Rgb;
use serde::de::value::{MapAccessDeserializer, MapDeserializer};
use serde::de::{DeserializeOwned, Error as _, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

/// A choice written as a bare name, `"albedo"`, or with its parameters, `{ albedo = { from = 3 } }`.
#[derive(Clone, Debug)]
pub struct Named<T>(pub T);

impl<'de, T: DeserializeOwned> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NamedVisitor(PhantomData)).map(Named)
    }
}

struct NamedVisitor<T>(PhantomData<T>);

impl<'de, T: DeserializeOwned> Visitor<'de> for NamedVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name, or a table { name = { ... } }")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<T, E> {
        let no_parameters = BTreeMap::<String, f64>::new();
        let table = MapDeserializer::new(std::iter::once((name, no_parameters)));
        T::deserialize(MapAccessDeserializer::new(table))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<T, A::Error> {
        let chosen = T::deserialize(MapAccessDeserializer::new(&mut map))?;
        match map.next_key::<String>()? {
            None => Ok(chosen),
            Some(other) => Err(A::Error::custom(format!(
                "a table names one choice, and `{other}` is another; give it a table of its own"
            ))),
        }
    }
}

/// One table `[x]`, or several `[[x]]`.
#[derive(Clone, Debug)]
pub struct Tables<T>(pub Vec<T>);

impl<'de, T: DeserializeOwned> Deserialize<'de> for Tables<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TablesVisitor(PhantomData)).map(Tables)
    }
}

struct TablesVisitor<T>(PhantomData<T>);

impl<'de, T: DeserializeOwned> Visitor<'de> for TablesVisitor<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table, or an array of tables")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Vec<T>, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(|table| vec![table])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec<T>, A::Error> {
        let mut tables = Vec::new();
        while let Some(table) = seq.next_element()? {
            tables.push(table);
        }
        Ok(tables)
    }
}

/// A number, or a list of numbers to sweep over.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep(pub Vec<f64>);

/// A number, or one for each of red, green and blue.
struct PerChannel(Rgb);

impl<'de> Deserialize<'de> for Sweep {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let values =
            deserializer.deserialize_any(NumbersVisitor("a number, or a list of numbers to sweep"))?;
        if values.is_empty() {
            return Err(D::Error::custom("an empty list leaves nothing to run; give at least one number"));
        }
        let most = bounds::CELLS;
        check(
            values.len() <= most,
            format!("a list of {}", values.len()),
            &format!("at most {most} numbers"),
        )?;
        Ok(Sweep(values))
    }
}

impl<'de> Deserialize<'de> for PerChannel {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a number, or three numbers [red, green, blue]";
        match deserializer.deserialize_any(NumbersVisitor(expected))?[..] {
            [v] => Ok(PerChannel(Rgb::splat(v))),
            [r, g, b] => Ok(PerChannel(Rgb::new(r, g, b))),
            ref other => Err(D::Error::custom(format!("{} numbers; expected {expected}", other.len()))),
        }
    }
}

struct NumbersVisitor(&'static str);

impl<'de> Visitor<'de> for NumbersVisitor {
    type Value = Vec<f64>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }

    fn visit_f64<E>(self, v: f64) -> Result<Vec<f64>, E> {
        Ok(vec![v])
    }

    fn visit_i64<E>(self, v: i64) -> Result<Vec<f64>, E> {
        Ok(vec![v as f64])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec<f64>, A::Error> {
        let mut values = Vec::new();
        while let Some(v) = seq.next_element::<f64>()? {
            values.push(v);
        }
        Ok(values)
    }
}

fn check<E: serde::de::Error>(holds: bool, value: impl fmt::Display, wanted: &str) -> Result<(), E> {
    if holds { Ok(()) } else { Err(E::custom(format!("{value} is out of range: {wanted}"))) }
}

/// Survival or splitting: q > 0, finite.
pub fn survival<'de, D: Deserializer<'de>>(d: D) -> Result<Sweep, D::Error> {
    let wanted = "q is the expected number of continuations, a finite number above 0 \
                  (at 0 nothing survives that could make up for the rest)";
    swept(d, wanted, |v| v > 0.0 && v.is_finite())
}

/// Whole numbers from 0, to sweep over.
pub fn counts<'de, D: Deserializer<'de>>(d: D) -> Result<Sweep, D::Error> {
    swept(d, "a whole number from 0 to 1000", |v| v.fract() == 0.0 && (0.0..=1000.0).contains(&v))
}

/// Whole numbers from 1, to sweep over.
pub fn positive_counts<'de, D: Deserializer<'de>>(d: D) -> Result<Sweep, D::Error> {
    swept(d, "a whole number from 1 to 1000", |v| v.fract() == 0.0 && (1.0..=1000.0).contains(&v))
}

/// Numbers to sweep over, each of which `holds`; `wanted` says what would be right.
pub fn swept<'de, D: Deserializer<'de>>(
    d: D,
    wanted: &str,
    holds: impl Fn(f64) -> bool,
) -> Result<Sweep, D::Error> {
    let sweep = Sweep::deserialize(d)?;
    sweep.0.iter().try_for_each(|&v| check(holds(v), v, wanted))?;
    Ok(sweep)
}

/// A probability or margin strictly inside (0, 1).
pub fn inside_unit<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    check(v > 0.0 && v < 1.0, v, "it lies inside (0, 1)")?;
    Ok(v)
}

/// A relative error in [0, 1).
pub fn relative_error<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    check((0.0..1.0).contains(&v), v, "a relative error lies in [0, 1)")?;
    Ok(v)
}

/// A whole number from 1, where the key may be absent.
pub fn optional_count<'de, D: Deserializer<'de>>(d: D) -> Result<Option<u32>, D::Error> {
    let v = i64::deserialize(d)?;
    check((1..=1_000_000_000).contains(&v), v, "a whole number from 1 to 10^9")?;
    Ok(Some(v as u32))
}

/// Tables of one kind: so many that each can be held against all cells.
pub fn tables<'de, D: Deserializer<'de>, T: Deserialize<'de>>(d: D) -> Result<Vec<T>, D::Error> {
    let tables = Vec::deserialize(d)?;
    let (has, most) = (tables.len(), bounds::TABLES);
    check(has <= most, format!("a list of {has} tables"), &format!("at most {most} of one kind"))?;
    Ok(tables)
}

/// Paths of a block.
pub fn optional_block<'de, D: Deserializer<'de>>(d: D) -> Result<Option<u64>, D::Error> {
    let v = i64::deserialize(d)?;
    check((64..=1 << 30).contains(&v), v, "a whole number of paths from 64 to 2^30")?;
    Ok(Some(v as u64))
}

/// Seeds of a study.
pub fn optional_seeds<'de, D: Deserializer<'de>>(d: D) -> Result<Option<u32>, D::Error> {
    let v = i64::deserialize(d)?;
    check((1..=MOST_SEEDS).contains(&v), v, "a whole number of seeds from 1 to 10^6")?;
    Ok(Some(v as u32))
}

/// Runs that samples are cut into.
pub fn runs<'de, D: Deserializer<'de>>(d: D) -> Result<u64, D::Error> {
    const LEAST: i64 = crate::stats::decay::MIN_RUNS as i64;
    let v = i64::deserialize(d)?;
    check(
        (LEAST..=1_000_000).contains(&v),
        v,
        "a whole number of runs from 8 to 10^6; fewer give no interval",
    )?;
    Ok(v as u64)
}

/// A probability in (0, 1].
pub fn probability<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    check(v > 0.0 && v <= 1.0, v, "it lies in (0, 1]")?;
    Ok(v)
}

/// More realizations than this are a slip of the finger.
pub const MOST_SAMPLES: i64 = 1_000_000_000_000_000;

/// A study keeps what each of its runs has found.
pub const MOST_SEEDS: i64 = 1_000_000;

/// A number of bounces: 0 to 1000.
pub fn bounces<'de, D: Deserializer<'de>>(d: D) -> Result<u32, D::Error> {
    let v = i64::deserialize(d)?;
    check((0..=1000).contains(&v), v, "a number of bounces lies in 0 to 1000")?;
    Ok(v as u32)
}

/// As [`bounces`], where the key may be absent.
pub fn optional_bounces<'de, D: Deserializer<'de>>(d: D) -> Result<Option<u32>, D::Error> {
    bounces(d).map(Some)
}

/// A number of samples: at least 1.
pub fn samples<'de, D: Deserializer<'de>>(d: D) -> Result<u64, D::Error> {
    let v = i64::deserialize(d)?;
    check((1..=MOST_SAMPLES).contains(&v), v, "at least 1 sample is needed, and at most 10^15")?;
    Ok(v as u64)
}

/// As [`samples`], where the key may be absent.
pub fn optional_samples<'de, D: Deserializer<'de>>(d: D) -> Result<Option<u64>, D::Error> {
    samples(d).map(Some)
}

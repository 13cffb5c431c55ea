//! What the deserializers of this module take, as JSON schemas: as narrow as a schema can be, never narrower than they.

use super::{MOST_SAMPLES, MOST_SEEDS, Named, Sweep, Tables};
use crate::faults;
use crate::scene::many_spheres::COUNTS;
use crate::stats::decay::MIN_RUNS;
use crate::truth::gallery::EXHIBITS;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};
use std::borrow::Cow;

type Bounds = [(&'static str, f64)];

/// A number, or a whole number, within bounds.
fn of(kind: &str, bounds: &Bounds) -> Schema {
    let mut schema = json_schema!({ "type": kind });
    for &(name, bound) in bounds {
        let whole = bound.fract() == 0.0 && bound.abs() < 1e16;
        let bound = if whole { json!(bound as i64) } else { json!(bound) };
        schema.insert(name.to_owned(), bound);
    }
    schema
}

fn number(bounds: &Bounds) -> Schema {
    of("number", bounds)
}

fn whole(least: impl Into<f64>, most: impl Into<f64>) -> Schema {
    of("integer", &[("minimum", least.into()), ("maximum", most.into())])
}

/// A value, or a list of values to sweep over.
fn swept(value: Schema) -> Schema {
    json_schema!({ "anyOf": [value, { "type": "array", "items": value, "minItems": 1 }] })
}

/// A value, or one for each of red, green and blue.
fn per_channel(value: Schema) -> Schema {
    json_schema!({ "anyOf": [value, { "type": "array", "items": value, "minItems": 3, "maxItems": 3 }] })
}

/// One of these names.
fn names(all: impl Iterator<Item = (&'static str, String)>) -> Schema {
    let one = |(name, what): (&str, String)| json!({ "const": name, "description": what });
    json_schema!({ "type": "string", "oneOf": all.map(one).collect::<Vec<_>>() })
}

/// A function for each deserializer, by the same name.
macro_rules! schemas {
    ($($name:ident: $schema:expr;)*) => { $(
        #[doc = concat!("What `", stringify!($name), "` takes.")]
        pub fn $name(_: &mut SchemaGenerator) -> Schema {
            $schema
        }
    )* };
}

const POSITIVE: &Bounds = &[("exclusiveMinimum", 0.0)];
const NOT_NEGATIVE: &Bounds = &[("minimum", 0.0)];
const UNIT: &Bounds = &[("minimum", 0.0), ("maximum", 1.0)];
const INSIDE_UNIT: &Bounds = &[("exclusiveMinimum", 0.0), ("exclusiveMaximum", 1.0)];

schemas! {
    inside_unit: number(INSIDE_UNIT);
    relative_error: number(&[("minimum", 0.0), ("exclusiveMaximum", 1.0)]);
    probability: number(&[("exclusiveMinimum", 0.0), ("maximum", 1.0)]);
    survival: swept(number(POSITIVE));
    counts: swept(whole(0, 1000));
    positive_counts: swept(whole(1, 1000));
    optional_count: whole(1, 1_000_000_000);
    optional_seeds: whole(1, MOST_SEEDS as f64);
    optional_block: whole(64, (1_u64 << 30) as f64);
    runs: whole(MIN_RUNS as f64, 1_000_000);
    bounces: whole(0, 1000);
    optional_bounces: whole(0, 1000);
    samples: whole(1, MOST_SAMPLES as f64);
    optional_samples: whole(1, MOST_SAMPLES as f64);

    albedo: per_channel(number(UNIT));
    optional_albedo: per_channel(number(UNIT));
    index: per_channel(number(NOT_NEGATIVE));
    radiance: per_channel(number(NOT_NEGATIVE));
    tiles: swept(whole(1, 6));
    fractions: swept(number(INSIDE_UNIT));
    length: number(POSITIVE);
    relative_index: number(POSITIVE);
    exponent: number(&[("minimum", 0.0), ("maximum", 1e6)]);
    roughness: number(&[("minimum", 0.001), ("maximum", 1.0)]);
    resolution: whole(1, 4096);
    wide_resolution: whole(1, 3072);
    vector: json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 });
    direction: vector(&mut SchemaGenerator::default());
    field_of_view: number(&[("exclusiveMinimum", 0.0), ("exclusiveMaximum", 180.0)]);
    half_edges: swept(number(&[("minimum", 1e-4), ("maximum", 0.3)]));
    apertures: swept(number(&[("exclusiveMinimum", 0.0), ("maximum", 0.5)]));
    travels: swept(number(UNIT));
    ball_counts: swept(whole(*COUNTS.start(), *COUNTS.end()));
    exhibit: names(EXHIBITS.iter().map(|e| (e.name, e.about.to_owned())));
    fault: names(faults::all().map(|fault| (fault.name, fault.about.to_owned())));
    faults: json_schema!({ "type": "array", "items": fault(&mut SchemaGenerator::default()) });

    photons: swept(whole(1, 100_000_000));
    nearest: swept(whole(2, 1_000_000));
    lengths: swept(number(POSITIVE));
    shares: swept(number(INSIDE_UNIT));
    levels: swept(number(INSIDE_UNIT));
    biases: swept(number(&[("exclusiveMinimum", -1.0), ("maximum", 10.0)]));
}

impl JsonSchema for Sweep {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Sweep".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        swept(number(&[]))
    }
}

impl<T: JsonSchema> JsonSchema for Tables<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Tables_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        swept(generator.subschema_for::<T>())
    }
}

impl<T: JsonSchema> JsonSchema for Named<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Named_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let tables = generator.subschema_for::<T>();
        let choices = T::json_schema(generator);
        let choices = choices.get("oneOf").and_then(Value::as_array).cloned().unwrap_or_default();
        let bare = choices.iter().filter_map(|choice| bare(choice, generator));
        json_schema!({ "anyOf": [{ "type": "string", "oneOf": bare.collect::<Vec<_>>() }, tables] })
    }
}

/// A file has no null, a key is there or is left out; and descriptions are one line each.
pub fn for_files(schema: &mut Schema) {
    fn clean(schema: &mut Schema) {
        if let Some(Value::Array(types)) = schema.get_mut("type") {
            types.retain(|name| name != "null");
        }
        if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
            choices.retain(|choice| choice.get("type").is_none_or(|name| name != "null"));
        }
        if schema.get("default").is_some_and(Value::is_null) {
            schema.remove("default");
        }
        if let Some(Value::String(text)) = schema.get_mut("description") {
            *text = text.replace('\n', " ");
        }
    }
    RecursiveTransform(clean).transform(schema);
}

/// The bare name of a choice, if all of its parameters may be left out.
fn bare(choice: &Value, generator: &SchemaGenerator) -> Option<Value> {
    let (name, parameters) = choice.get("properties")?.as_object()?.iter().next()?;
    let named = parameters.get("$ref").and_then(Value::as_str).and_then(|r| r.rsplit('/').next());
    let parameters = named.and_then(|named| generator.definitions().get(named)).unwrap_or(parameters);
    if parameters.get("required").is_some() {
        return None;
    }
    let mut bare = Map::from_iter([("const".to_owned(), json!(name))]);
    bare.extend(choice.get("description").map(|what| ("description".to_owned(), what.clone())));
    Some(Value::Object(bare))
}

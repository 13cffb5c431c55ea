//! Promise: the schema of experiment files takes all of them, refuses the usual mistakes, and refuses nothing that the
//! program takes; so what an editor underlines is wrong indeed.

use furnace::experiment::{Overrides, Plan, spec};
use jsonschema::Validator;
use serde_json::Value;
use std::fs;
use std::path::Path;

const GOOD: &str = r#"question = "Is it known?"
seed = 1
samples = 64_000
claim = [{ unbiased = { alpha = 1e-3, margin = 0.01 } }]
plot = [{ bias = {} }]
[grid]
scene = ["furnace"]
estimator = ["implicit"]
roulette = ["albedo"]
"#;

fn schema() -> Value {
    serde_json::from_str(&spec::schema()).unwrap()
}

fn validator() -> Validator {
    jsonschema::validator_for(&schema()).unwrap()
}

/// A file as the JSON that an editor checks.
fn json(toml: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(toml).unwrap()).unwrap()
}

/// The good file with this line in the place of the one of its key, or at its top.
fn with(line: &str) -> String {
    let key = line.split('=').next().unwrap().trim();
    let is_key = |other: &&str| other.split('=').next().unwrap().trim() == key;
    match GOOD.lines().find(is_key) {
        Some(old) => GOOD.replace(old, line),
        None => format!("{line}\n{GOOD}"),
    }
}

fn takes(toml: &str) -> Result<(), String> {
    let plan = Plan::new("x", Path::new("experiments/x.toml"), toml, &Overrides::default());
    plan.map(drop).map_err(|error| error.to_string())
}

#[test]
fn the_committed_schema_is_the_one_that_is_printed() {
    let committed = fs::read_to_string("experiments/schema.json").unwrap();
    let hint = "cargo run --bin experiment schema > experiments/schema.json";
    assert!(committed == spec::schema(), "it is another; make it anew: {hint}");
}

#[test]
fn all_experiments_are_taken() {
    let validator = validator();
    let mut count = 0;
    for entry in fs::read_dir("experiments").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let name = path.display();
        assert_eq!(text.lines().next(), Some("#:schema schema.json"), "{name} does not name its schema");
        let errors: Vec<String> = validator.iter_errors(&json(&text)).map(|e| e.to_string()).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
        count += 1;
    }
    assert!(count > 15);
}

/// A line each, all of which the program refuses and an editor can know to be wrong.
const MISTAKES: [&str; 53] = [
    "sed = 7",
    "seed = -1",
    "seed = 1.5",
    "question = 7",
    "samples = 0",
    "samples = \"many\"",
    "samples = 2_000_000_000_000_000",
    "max_samples = 0",
    "runs = 4",
    "seeds = 0",
    "streams = \"shared\"",
    "core = \"slow\"",
    "scene = []",
    "scene = \"furnace\"",
    "scene = [\"furnac\"]",
    "scene = [{ furnace = { albdo = 0.5 } }]",
    "scene = [{ furnace = { albedo = 1.5 } }]",
    "scene = [{ furnace = { albedo = [0.1, 0.2] } }]",
    "scene = [{ furnace = { albedo = true } }]",
    "scene = [{ furnace = { emission = -1 } }]",
    "scene = [{ furnace = { view = \"from_afar\" } }]",
    "scene = [{ furnace = {}, furnace_box = {} }]",
    "scene = [{ integrating_sphere = { light_fraction = 1.0 } }]",
    "scene = [{ cornell_box = { resolution = 5000 } }]",
    "scene = [{ cornell_flush = { tile = 7 } }]",
    "scene = [{ many_spheres = { count = 0 } }]",
    "scene = [\"exhibit\"]",
    "scene = [{ exhibit = { name = \"kitchen\" } }]",
    "scene = [{ exhibit = { name = \"disk_light\", parameter = [] } }]",
    "scene = [{ caustic_glass = { light = 0.5 } }]",
    "scene = [{ dof = { aperture = 0 } }]",
    "scene = [{ motion = { travel = 2 } }]",
    "estimator = [\"explicti\"]",
    "estimator = [\"recursive\"]",
    "estimator = [{ recursive = { samples = 0, depth = 2 } }]",
    "estimator = [{ recursive = { samples = 2, depth = 1001 } }]",
    "estimator = [{ explicit = { heuristic = \"maximum\" } }]",
    "estimator = [{ photon_map = { k = 1 } }]",
    "estimator = [{ photon_map = { radius = 0 } }]",
    "estimator = [{ photon_map = { k = 9, kernel = { cone = { c = 0.5 } } } }]",
    "estimator = [{ progressive = { radius = 0.1, alpha = 1, passes = 9 } }]",
    "estimator = [{ fault = { name = \"no_such_slip\" } }]",
    "roulette = [\"constant\"]",
    "roulette = [{ constant = { p = 0.5 } }]",
    "roulette = [{ constant = { q = 0 } }]",
    "roulette = [{ constant = { q = [] } }]",
    "roulette = [{ depth_clamp = { bounces = 2.5 } }]",
    "roulette = [{ throughput = { floor = 0 } }]",
    "claim = [{ length = { alpha = 0.1 }, independent = { alpha = 0.1 } }]",
    "claim = [{ unbiased = { alpha = 1e-3 } }]",
    "claim = [{ unbiased = { alpha = 1.5, margin = 0.1 } }]",
    "null = [{ law = { rare = { p = 0 } }, samples = 9, runs = 9, level = 0.01 }]",
    "plot = [{ over = { parameter = \"q\", show = [\"byas\"] } }]",
];

#[test]
fn mistakes_are_known() {
    let validator = validator();
    assert!(validator.is_valid(&json(GOOD)), "{:?}", validator.validate(&json(GOOD)).err());
    takes(GOOD).unwrap();
    for mistake in MISTAKES {
        let toml = with(mistake);
        assert!(!validator.is_valid(&json(&toml)), "the schema takes {mistake}");
        assert!(takes(&toml).is_err(), "the program takes {mistake}, which the schema refuses");
    }
}

/// The ends of ranges and the ways to write a thing.
const RIGHT: [&str; 30] = [
    "samples = 1",
    "max_samples = 1_000_000_000_000_000",
    "core = \"fast\"",
    "scene = [{ furnace = {} }, \"furnace_box\"]",
    "scene = [{ furnace = { albedo = 0, emission = 1 } }]",
    "scene = [{ furnace = { albedo = [0.999, 0.5, 0], emission = [0, 1, 2.5] } }]",
    "scene = [{ integrating_sphere = { light_fraction = [0.01, 0.9] } }]",
    "scene = [{ cornell_box = { resolution = 1 } }]",
    "scene = [{ cornell_flush = { tile = [1, 6], blocks = true } }]",
    "scene = [{ many_spheres = { count = 10, resolution = 2 } }]",
    "scene = [{ caustic_glass = { light = 0.3, resolution = 2 } }]",
    "scene = [{ dof = { aperture = [0.5, 0.01], resolution = 2 } }]",
    "scene = [{ motion = { travel = [0, 1], resolution = 2 } }]",
    "scene = [{ exhibit = { name = \"disk_light\", parameter = [0.5, 1] } }]",
    "estimator = [\"explicit\", \"light_tracing\", { implicit = { directions = \"uniform\" } }]",
    "estimator = [{ explicit = { technique = \"both\", heuristic = \"power\", pick = \"uniform\" } }]",
    "estimator = [{ explicit = { lights = \"solid_angle\" } }]",
    "estimator = [{ recursive = { samples = [1, 3], depth = 2 } }]",
    "roulette = [{ constant = { q = [0.1, 0.9] } }]",
    "roulette = [{ constant = { q = 1.5, from = 2, clamp = 5 } }]",
    "roulette = [{ throughput = { floor = 0.9, from = 2 } }, { throughput = {} }]",
    "roulette = [{ depth_clamp = { bounces = [0, 9] } }]",
    "claim = [{ cost = { alpha = 0.999, margin = 1e-9, scene = \"furnace\" } }, { length = { alpha = 0.1 } }]",
    "claim = [{ agree = { estimator = \"implicit\", roulette = \"albedo\", alpha = 0.1, margin = 0.1 } }]",
    "plot = []",
    "answer = \"Nothing.\"",
    "streams = \"paired\"",
    "runs = 8",
    "null = [{ law = { walk = { albedo = 0, q = 0.5 } }, samples = 1, runs = 2, level = [0.1, 0.2], bias = -0.5 }]",
    "null = [{ law = { lognormal = { sigma = 3 } }, samples = 1, runs = 2, level = 0.5, bias = [10, 0] }]",
];

#[test]
fn what_is_right_is_not_underlined() {
    let validator = validator();
    for line in RIGHT {
        let toml = with(line);
        takes(&toml).unwrap_or_else(|error| panic!("the program refuses {line}: {error}"));
        let errors: Vec<String> = validator.iter_errors(&json(&toml)).map(|e| e.to_string()).collect();
        assert!(errors.is_empty(), "the schema refuses {line}: {errors:?}");
    }
}

#[test]
fn descriptions_are_for_those_who_write_files() {
    fn descriptions<'a>(value: &'a Value, all: &mut Vec<&'a str>) {
        match value {
            Value::Object(map) => {
                all.extend(map.get("description").and_then(Value::as_str));
                map.values().for_each(|value| descriptions(value, all));
            }
            Value::Array(items) => items.iter().for_each(|item| descriptions(item, all)),
            _ => {}
        }
    }
    let schema = schema();
    let mut all = Vec::new();
    descriptions(&schema, &mut all);
    assert!(all.len() > 200, "{}", all.len());
    for text in all {
        assert!(!text.contains("::") && !text.contains('\n') && !text.is_empty(), "{text}");
    }
    let undescribed =
        schema["properties"].as_object().unwrap().iter().find(|(_, v)| v["description"].is_null());
    assert!(undescribed.is_none(), "{undescribed:?}");
}

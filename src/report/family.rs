//! Cells that differ only in their estimator and in one parameter of their scene: what a sentence may compare.

use super::lookup::Lookup;
use crate::scene::lecture::Lecture;
use crate::scene::library::SceneKind;
use crate::truth::gallery;

/// Finished cells of one scene under one termination rule, without those that make a known mistake.
pub struct Family {
    /// Indices of the cells.
    pub cells: Vec<usize>,
    /// The parameter of the scene that is swept, if any.
    pub parameter: Option<&'static str>,
}

/// All families, in the order of their first cells.
pub fn families(lookup: &Lookup<'_>) -> Vec<Family> {
    let cells = &lookup.plan.cells;
    let mut families: Vec<Family> = Vec::new();
    for i in (0..cells.len()).filter(|&i| !lookup.cell(i).is_empty() && !lookup.is_faulty(i)) {
        let parameter = swept(lookup, i);
        let alike = |family: &&mut Family| {
            let first = &cells[family.cells[0]];
            let others = |cell: usize| {
                let params = cells[cell].params.iter();
                params.filter(|(name, _)| Some(name.as_str()) != parameter).collect::<Vec<_>>()
            };
            family.parameter == parameter
                && first.scene_label == cells[i].scene_label
                && first.roulette_label == cells[i].roulette_label
                && others(family.cells[0]) == others(i)
                && (parameter.is_some() || first.scene == cells[i].scene)
        };
        match families.iter_mut().find(alike) {
            Some(family) => family.cells.push(i),
            None => families.push(Family { cells: vec![i], parameter }),
        }
    }
    families
}

/// The parameter of a cell's scene, if it is swept.
fn swept(lookup: &Lookup<'_>, cell: usize) -> Option<&'static str> {
    let name = match &lookup.plan.cells[cell].scene {
        SceneKind::Exhibit { name, .. } => gallery::find(name)?.parameter.name,
        SceneKind::IntegratingSphere { .. } => "light_fraction",
        SceneKind::CornellFlush { .. } => "tile",
        SceneKind::ManySpheres { .. } => "count",
        SceneKind::Lecture(Lecture::CausticGlass { .. } | Lecture::CausticMirror { .. }) => "light",
        SceneKind::Lecture(Lecture::Dof { .. }) => "aperture",
        SceneKind::Lecture(Lecture::Motion { .. }) => "travel",
        _ => return None,
    };
    let is_swept = lookup.plan.swept.iter().any(|swept| swept == name);
    (is_swept && lookup.plan.cells[cell].params.contains_key(name)).then_some(name)
}

/// The scene with another value of its parameter, where that is defined.
pub fn scene_at(scene: &SceneKind, parameter: &str, value: f64) -> Option<SceneKind> {
    match scene {
        SceneKind::Exhibit { name, .. } => {
            let exhibit = gallery::find(name).filter(|exhibit| exhibit.parameter.name == parameter)?;
            exhibit.parameter.range.contains(&value).then(|| exhibit.scene(value))
        }
        SceneKind::IntegratingSphere { patches, looks_at, view } if parameter == "light_fraction" => {
            let mut patches = patches.clone();
            let wall = patches.len() - 1;
            patches[wall].fraction += patches[0].fraction - value;
            patches[0].fraction = value;
            Some(SceneKind::IntegratingSphere { patches, looks_at: *looks_at, view: *view })
        }
        _ => None,
    }
}

impl Family {
    /// Scene and rule.
    pub fn subject(&self, lookup: &Lookup<'_>) -> String {
        let plan = lookup.plan;
        let cell = &plan.cells[self.cells[0]];
        let mut parts = vec![cell.scene_label.clone(), cell.roulette_label.clone()];
        let others = cell.params.iter().filter(|(name, _)| Some(name.as_str()) != self.parameter);
        let swept = others.filter(|(name, _)| plan.swept.contains(name));
        parts.extend(swept.map(|(name, value)| format!("{name} = {value}")));
        parts.join(", ")
    }

    /// Values of the parameter in ascending order, each with its cells; one of no meaning if there is no parameter.
    pub fn points(&self, lookup: &Lookup<'_>) -> Vec<(f64, Vec<usize>)> {
        let value = |cell: usize| self.parameter.map_or(0.0, |name| lookup.plan.cells[cell].params[name]);
        let mut points: Vec<(f64, Vec<usize>)> = Vec::new();
        for &cell in &self.cells {
            match points.iter_mut().find(|(v, _)| *v == value(cell)) {
                Some((_, cells)) => cells.push(cell),
                None => points.push((value(cell), vec![cell])),
            }
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    /// Names of its estimators, in their order.
    pub fn estimators<'a>(&self, lookup: &Lookup<'a>) -> Vec<&'a str> {
        let mut names: Vec<&str> = Vec::new();
        for &cell in &self.cells {
            let name = lookup.plan.cells[cell].estimator_label.as_str();
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }
}

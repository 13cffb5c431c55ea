//! What an estimator can find in a scene, and where it has nothing to look for.

use super::plan::CellPlan;
use crate::estimator::Estimator;
use crate::sampling::Address;
use crate::scene::Scene;
use crate::truth::ClosedForm;

/// Why a cell is not run: its estimator cannot work there, or misses light and nobody knows how much.
pub fn out_of(cell: &CellPlan, scene: &Scene) -> Option<String> {
    match &cell.estimator {
        Estimator::LightTracing(_) if !scene.sensor.has_extent() => {
            Some("no particle meets a probe, which is a single ray".to_owned())
        }
        Estimator::PhotonMap(_) if scene.moves() => {
            Some("a photon map holds one moment, and this scene moves".to_owned())
        }
        _ if !cell.finds_all && ClosedForm::of(&cell.scene, &cell.estimator).is_none() => {
            Some("its paths do not find all light of the scene's points".to_owned())
        }
        _ => None,
    }
}

/// Whether no light is out of an estimator's reach: paths from the eye find points by sampling them only, and not behind
/// mirrors or glass; particles do not reach what the eye sees in them, which is what `sees_smooth` tells.
pub fn finds_all(estimator: &Estimator, scene: &Scene, sees_smooth: impl Fn() -> bool) -> bool {
    let smooth = || scene.surfaces().iter().any(|s| s.material.bsdf.is_dirac());
    scene.points().next().is_none()
        || match estimator {
            Estimator::PhotonMap(_) => true,
            Estimator::LightTracing(_) => !sees_smooth(),
            _ => estimator.samples_lights() && !smooth(),
        }
}

/// Pixels along each edge that are looked at, at most.
const LOOKED_AT: u32 = 512;

/// Whether one of many rays from the sensor meets a mirror or glass first.
/// The pixels of a large image are looked at in part.
pub fn sees_smooth(scene: &Scene) -> bool {
    let (width, height) = scene.sensor.resolution();
    let rays = 4096 / (width * height).min(4096) + 1;
    let address = Address::of(&["what the sensor sees"]);
    let meets = |ray: u32, x: u32, y: u32| {
        let start = scene.start((x, y), &mut address.stream(u64::from(ray), u64::from(y * width + x)));
        scene.intersect(&start.ray, start.time).is_some_and(|x| x.material.bsdf.is_dirac())
    };
    let step = |edge: u32| edge.div_ceil(LOOKED_AT) as usize;
    let (columns, rows) = (step(width), step(height));
    (0..height)
        .step_by(rows)
        .any(|y| (0..width).step_by(columns).any(|x| (0..rays).any(|ray| meets(ray, x, y))))
}

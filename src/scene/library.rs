//! Named scenes. Each is off-centre, of a radius other than 1 and without a privileged axis on purpose:
//! symmetry and unit sizes hide mistakes.

use super::cornell::cornell;
use super::cornell_flush::cornell_flush;
use super::geometry::{Rectangle, SpherePatch};
use super::lecture::Lecture;
use super::many_spheres;
use super::{Material, PointLight, Rgb, Scene, Sensor, Shape, Sky, Surface};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scene and its parameters, all of them resolved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SceneKind {
    /// A closed sphere of one material, seen from inside: radiance le / (1 - albedo) everywhere.
    Furnace {
        /// Albedo per channel, in [0, 1).
        albedo: Rgb,
        /// Emitted radiance [W m^-2 sr^-1].
        emission: Rgb,
        /// What is measured.
        view: View,
    },
    /// The same closed form in a closed box whose three edges differ.
    FurnaceBox {
        /// Albedo per channel, in [0, 1).
        albedo: Rgb,
        /// Emitted radiance [W m^-2 sr^-1].
        emission: Rgb,
        /// What is measured.
        view: View,
    },
    /// A sphere of patches, seen from inside.
    IntegratingSphere {
        /// Bands of one sphere from one pole to the other; their fractions sum to 1.
        patches: Vec<Patch>,
        /// Which patch a probe looks at.
        looks_at: usize,
        /// What is measured.
        view: View,
    },
    /// The Cornell box with its two blocks.
    CornellBox {
        /// Pixels along each edge of the image.
        resolution: u32,
    },
    /// The Cornell box without blocks.
    CornellEmpty {
        /// Pixels along each edge of the image.
        resolution: u32,
    },
    /// A Cornell box in the unit cube whose light lies flush in the ceiling; measured is one of six tiles.
    CornellFlush {
        /// Which tile, 0 to 5.
        tile: usize,
        /// Whether the two blocks stand in it.
        blocks: bool,
    },
    /// A room full of balls; see [`super::many_spheres`].
    ManySpheres {
        /// How many, in [`super::many_spheres::COUNTS`].
        count: u32,
        /// Pixels along each edge of the image.
        resolution: u32,
    },
    /// A scene of lectures, hard for some estimators and without a closed form.
    Lecture(Lecture),
    /// A scene of the gallery, which has a closed form.
    Exhibit {
        /// Its name in the gallery.
        name: String,
        /// The parameter that can be swept.
        parameter: f64,
        /// What there is.
        setting: Setting,
    },
    /// Written out primitive by primitive in an experiment file.
    Custom(Setting),
}

/// A scene, primitive by primitive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// The surfaces.
    pub primitives: Vec<Primitive>,
    /// Lights without extent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<PointLight>,
    /// Light from infinity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sky: Option<Sky>,
    /// What is measured.
    pub sensor: Sensor,
}

/// How a closed-form scene is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum View {
    /// Radiance along one ray.
    #[default]
    Probe,
    /// Irradiance on a small plate.
    Irradiance,
}

/// A part of an integrating sphere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Patch {
    /// Fraction of the sphere's area, in (0, 1].
    pub fraction: f64,
    /// Albedo per channel.
    pub albedo: Rgb,
    /// Emitted radiance [W m^-2 sr^-1].
    pub emission: Rgb,
}

/// One primitive of a scene that is written out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Primitive {
    /// Its shape; the front is where its normal points.
    pub shape: Shape,
    /// What it is made of.
    pub material: Material,
    /// Way that it goes during the exposure.
    #[serde(default)]
    pub velocity: DVec3,
}

const CENTER: DVec3 = DVec3::new(0.3, -0.2, 0.5);
const RADIUS: f64 = 1.3;

impl SceneKind {
    /// Surfaces and lights that it holds itself, and does not only name.
    pub fn written(&self) -> usize {
        match self {
            SceneKind::Custom(setting) => setting.primitives.len() + setting.points.len(),
            _ => 0,
        }
    }

    /// Surfaces that it is told to have, or one.
    pub fn named(&self) -> usize {
        match self {
            SceneKind::ManySpheres { count, .. } => *count as usize,
            _ => self.written().max(1),
        }
    }

    /// Builds the scene.
    pub fn build(&self) -> Scene {
        match self {
            SceneKind::Furnace { albedo, emission, view } => furnace(*albedo, *emission, *view),
            SceneKind::FurnaceBox { albedo, emission, view } => furnace_box(*albedo, *emission, *view),
            SceneKind::IntegratingSphere { patches, looks_at, view } => {
                integrating_sphere(patches, *looks_at, *view)
            }
            SceneKind::CornellBox { resolution } => cornell(true, *resolution),
            SceneKind::CornellEmpty { resolution } => cornell(false, *resolution),
            SceneKind::CornellFlush { tile, blocks } => cornell_flush(*tile, *blocks),
            SceneKind::ManySpheres { count, resolution } => many_spheres::scene(*count, *resolution),
            SceneKind::Lecture(lecture) => lecture.build(),
            SceneKind::Exhibit { setting, .. } | SceneKind::Custom(setting) => setting.build(),
        }
    }
}

/// A direction that no coordinate axis shares.
fn oblique() -> DVec3 {
    DVec3::new(0.36, 0.48, 0.8)
}

fn furnace(albedo: Rgb, emission: Rgb, view: View) -> Scene {
    let whole = Patch { fraction: 1.0, albedo, emission };
    integrating_sphere(&[whole], 0, view)
}

fn furnace_box(albedo: Rgb, le: Rgb, view: View) -> Scene {
    let half = DVec3::new(0.7, 1.1, 1.9);
    let material = Material::lambert(albedo, le);
    let wall = |axis: usize, sign: f64| {
        let inward = -sign * DVec3::AXES[axis];
        let half_u = DVec3::AXES[(axis + 1) % 3] * half[(axis + 1) % 3];
        let half_v = inward.cross(half_u).normalize() * half[(axis + 2) % 3];
        let center = CENTER + sign * half[axis] * DVec3::AXES[axis];
        Surface::new(Shape::Rectangle(Rectangle { center, half_u, half_v }), material)
    };
    let walls = (0..3).flat_map(|axis| [wall(axis, 1.0), wall(axis, -1.0)]).collect();
    let (point, direction) = (CENTER + 0.3 * half, -oblique());
    let sensor = match view {
        View::Probe => Sensor::Probe { origin: point, direction },
        View::Irradiance => Sensor::Irradiance { point, normal: direction, on: None },
    };
    Scene::new(walls, sensor)
}

fn integrating_sphere(patches: &[Patch], looks_at: usize, view: View) -> Scene {
    let mut low = 1.0;
    let mut surfaces = Vec::new();
    let mut target = DVec3::ZERO;
    for (i, patch) in patches.iter().enumerate() {
        let high = low;
        low = if i + 1 == patches.len() { -1.0 } else { high - 2.0 * patch.fraction };
        let (center, radius, axis) = (CENTER, RADIUS, oblique());
        let band = SpherePatch { center, radius, axis, low, high, inward: true };
        let material = Material::lambert(patch.albedo, patch.emission);
        surfaces.push(Surface::new(Shape::Sphere(band), material));
        if i == looks_at {
            target = surfaces[i].sample_area((0.5, 0.3)).0;
        }
    }
    let eye = CENTER + DVec3::new(0.2, 0.1, -0.3);
    let sensor = match view {
        View::Probe => Sensor::Probe { origin: eye, direction: (target - eye).normalize() },
        View::Irradiance => {
            let normal = (CENTER - target).normalize();
            Sensor::Irradiance { point: target, normal, on: Some(looks_at as u32) }
        }
    };
    Scene::new(surfaces, sensor)
}

impl Setting {
    /// Whether nothing moves.
    pub fn is_at_rest(&self) -> bool {
        self.primitives.iter().all(|p| p.velocity == DVec3::ZERO)
    }

    fn build(&self) -> Scene {
        let surface = |p: &Primitive| Surface::moving(p.shape, p.material, p.velocity);
        Scene::lit_by(self.primitives.iter().map(surface).collect(), &self.points, self.sky, self.sensor)
    }
}

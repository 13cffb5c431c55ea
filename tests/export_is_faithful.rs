//! Promise: an exported scene says what the scene is. A reader that shares nothing with the writer finds the same
//! corners, fronts, materials, lights and rays in it; what Mitsuba cannot have is refused, with the reason.
//! (That Mitsuba measures the same is what `references/roundtrip.py` finds out.)

use assert_cmd::{Command, cargo::cargo_bin};
use furnace::report::mitsuba::{Placement, export};
use furnace::sampling::Address;
use furnace::scene::camera::{Camera, Lens};
use furnace::scene::geometry::{Disk, Rectangle, SpherePatch, Triangle};
use furnace::scene::lecture::{Lecture, Source};
use furnace::scene::library::{SceneKind, View};
use furnace::scene::{Bsdf, Material, PointLight, Rgb, Scene, Sensor, Shape, Sky, Surface};
use glam::{DMat4, DVec2, DVec3};
use std::collections::HashMap;

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// An element as it was read.
#[derive(Debug, Default)]
struct Node {
    tag: String,
    attributes: HashMap<String, String>,
    children: Vec<Node>,
}

/// Reads elements up to the end of the one that is open, or of the text.
fn read(text: &mut &str) -> Vec<Node> {
    let mut nodes = Vec::new();
    while let Some(start) = text.find('<') {
        assert!(text[..start].trim().is_empty(), "text between elements: {}", &text[..start]);
        let (tag, rest) = text[start + 1..].split_once('>').unwrap();
        *text = rest;
        if tag.starts_with('/') {
            break;
        }
        if tag.starts_with('?') {
            continue;
        }
        let inside = tag.trim_end_matches('/').trim_end();
        let (name, mut attributes) = inside.split_once(' ').unwrap_or((inside, ""));
        let mut node = Node { tag: name.to_owned(), ..Node::default() };
        while let Some((key, rest)) = attributes.split_once("=\"") {
            let (value, rest) = rest.split_once('"').unwrap();
            attributes = rest;
            assert!(!value.contains('<'));
            let value = value.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"");
            node.attributes.insert(key.trim().to_owned(), value.replace("&amp;", "&"));
        }
        if !tag.ends_with('/') {
            node.children = read(text);
        }
        nodes.push(node);
    }
    nodes
}

impl Node {
    fn all<'a>(&'a self, tag: &'a str) -> impl Iterator<Item = &'a Node> {
        self.children.iter().filter(move |child| child.tag == tag)
    }

    fn kind(&self) -> &str {
        &self.attributes["type"]
    }

    /// The value of the property of this name.
    #[track_caller]
    fn get(&self, name: &str) -> &str {
        let has = |child: &&Node| child.attributes.get("name").is_some_and(|n| n == name);
        let property = self.children.iter().find(has);
        &property.unwrap_or_else(|| panic!("no {name} in {self:#?}")).attributes["value"]
    }

    #[track_caller]
    fn number(&self, name: &str) -> f64 {
        self.get(name).parse().unwrap()
    }

    #[track_caller]
    fn triple(&self, name: &str) -> DVec3 {
        DVec3::from_slice(&numbers(self.get(name)))
    }

    fn to_world(&self) -> DMat4 {
        let transform = self.all("transform").next().unwrap();
        DMat4::from_cols_slice(&numbers(&transform.children[0].attributes["value"])).transpose()
    }
}

fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().map(|n| n.parse().unwrap()).collect()
}

#[track_caller]
fn near(got: DVec3, right: DVec3) {
    let error = (got - right).length();
    assert!(error <= 1e-14 * right.length().max(1.0), "{got} instead of {right}");
}

/// Exports and reads again: the scene, and the corners of all triangles with the node that they come from.
fn exported(scene: &Scene, placement: Placement) -> (Node, HashMap<String, Vec<DVec3>>) {
    let export = export(scene, placement, "x").unwrap();
    let mut roots = read(&mut export.xml.as_str());
    let corners = |obj: &str| -> Vec<DVec3> {
        let lines = |start| obj.lines().filter_map(move |line: &str| line.strip_prefix(start)).map(numbers);
        let vertices: Vec<DVec3> = lines("v ").map(|v| DVec3::from_slice(&v)).collect();
        assert_eq!(lines("v ").count() + lines("f ").count(), obj.lines().count());
        // vertices count from 1
        lines("f ").flatten().map(|i| vertices[i as usize - 1]).collect()
    };
    let meshes = export.meshes.iter().map(|mesh| (mesh.name.clone(), corners(&mesh.text))).collect();
    assert_eq!((roots.len(), roots[0].tag.as_str()), (1, "scene"));
    (roots.remove(0), meshes)
}

fn same_shape(shape: &Node, surface: &Shape, place: &dyn Fn(DVec3) -> DVec3) {
    let length = |v: f64| (place(at(v, 0.0, 0.0)) - place(DVec3::ZERO)).length();
    match surface {
        Shape::Sphere(s) => {
            assert_eq!(shape.kind(), "sphere");
            near(shape.triple("center"), place(s.center));
            assert!((shape.number("radius") - length(s.radius)).abs() < 1e-13);
            assert_eq!(shape.get("flip_normals"), s.inward.to_string());
        }
        Shape::Rectangle(r) => {
            assert_eq!(shape.kind(), "rectangle");
            for (s, t) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
                let right = place(r.center + s * r.half_u + t * r.half_v);
                near(shape.to_world().transform_point3(at(s, t, 0.0)), right);
            }
        }
        Shape::Disk(d) => {
            assert_eq!(shape.kind(), "disk");
            let m = shape.to_world();
            near(m.transform_point3(DVec3::ZERO), place(d.center));
            let (x, y) = (m.transform_vector3(DVec3::X), m.transform_vector3(DVec3::Y));
            let right = length(d.radius);
            assert!((x.length() - right).abs() < 1e-13 && (y.length() - right).abs() < 1e-13);
            assert!(x.dot(y).abs() < 1e-13);
        }
        Shape::Triangle(_) => unreachable!("triangles stand in meshes"),
    }
    if !matches!(surface, Shape::Sphere(_)) {
        // normals go with the inverse transpose
        let normal = shape.to_world().inverse().transpose().transform_vector3(DVec3::Z);
        near(normal.normalize(), surface.direction());
    }
}

fn same_material(shape: &Node, material: &Material) {
    let bsdf = shape.all("bsdf").next().unwrap();
    match material.bsdf {
        Bsdf::Lambert { albedo } => {
            assert_eq!((bsdf.kind(), bsdf.triple("reflectance")), ("diffuse", albedo));
        }
        Bsdf::Mirror { reflectance } => {
            assert_eq!((bsdf.kind(), bsdf.get("material")), ("conductor", "none"));
            assert_eq!(bsdf.triple("specular_reflectance"), reflectance);
        }
        Bsdf::Conductor { eta, k } => {
            assert_eq!((bsdf.kind(), bsdf.triple("eta"), bsdf.triple("k")), ("conductor", eta, k));
        }
        Bsdf::Glossy { alpha, eta, k } => {
            // Mitsuba's own default is another distribution
            assert_eq!((bsdf.kind(), bsdf.get("distribution")), ("roughconductor", "ggx"));
            assert_eq!((bsdf.number("alpha"), bsdf.triple("eta"), bsdf.triple("k")), (alpha, eta, k));
        }
        Bsdf::Dielectric { ior } => {
            assert_eq!((bsdf.kind(), bsdf.number("int_ior") / bsdf.number("ext_ior")), ("dielectric", ior));
        }
    }
    let emitters: Vec<DVec3> = shape.all("emitter").map(|e| e.triple("radiance")).collect();
    let right = if material.le == Rgb::ZERO { Vec::new() } else { vec![material.le] };
    assert_eq!(emitters, right);
}

/// Every ray of ours starts where one of Mitsuba's sensor does and goes there, in the same pixel.
fn same_rays(sensor: &Node, scene: &Scene, place: &dyn Fn(DVec3) -> DVec3) {
    let film = sensor.all("film").next().unwrap();
    let (width, height) = scene.sensor.resolution();
    assert_eq!((film.number("width"), film.number("height")), (width.into(), height.into()));
    assert_eq!(film.all("rfilter").next().unwrap().kind(), "box");
    let mut stream = Address::of(&["export"]).stream(0, 0);
    for pixel in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        for _ in 0..20 {
            let (ray, response) = scene.sensor.ray(pixel, &mut stream);
            assert_eq!(response, 1.0);
            let (o, towards) = (place(ray.o), place(ray.o + ray.d));
            if sensor.kind() == "radiancemeter" {
                near(sensor.triple("origin"), o);
                near(sensor.triple("direction"), ray.d);
                continue;
            }
            let to_local = sensor.to_world().inverse();
            let (o, towards) = (to_local.transform_point3(o), to_local.transform_point3(towards));
            let d = towards - o;
            assert!(sensor.number("near_clip") > 0.0 && d.z > 0.0);
            if sensor.kind() == "orthographic" {
                assert!(o.z.abs() < 1e-12 && o.truncate().abs().max_element() <= 1.0 + 1e-12);
                assert!(d.truncate().length() < 1e-12 * d.z);
                continue;
            }
            let o = match &scene.sensor {
                Sensor::Camera(camera) if camera.near > 0.0 => {
                    // it starts where Mitsuba begins to see, and comes from the eye
                    assert!((o.z / sensor.number("near_clip") - 1.0).abs() < 1e-12);
                    o - d * (o.z / d.z)
                }
                _ => o,
            };
            let focus = if sensor.kind() == "thinlens" {
                assert!(o.z.abs() < 1e-12 && o.length() <= sensor.number("aperture_radius") * (1.0 + 1e-9));
                sensor.number("focus_distance")
            } else {
                assert!(sensor.kind() == "perspective" && o.length() < 1e-12);
                1.0
            };
            // where it meets the plane in focus: x to the left, y up
            let seen = o + d * (focus / d.z);
            assert_eq!(sensor.get("fov_axis"), "y");
            let half = focus * (0.5 * sensor.number("fov")).to_radians().tan();
            let half = DVec2::new(half * f64::from(width) / f64::from(height), half);
            let raster =
                (DVec2::ONE - seen.truncate() / half) / 2.0 * DVec2::new(width.into(), height.into());
            let inside = raster - DVec2::new(pixel.0.into(), pixel.1.into());
            assert!(inside.min_element() > -1e-9 && inside.max_element() < 1.0 + 1e-9, "{pixel:?}: {raster}");
        }
    }
}

/// All of it, where it is, and moved and enlarged.
fn holds(scene: &Scene) {
    for placement in [Placement::SAME, Placement { center: at(0.4, -3.0, 1.7), scale: 100.0 }] {
        let place = |p: DVec3| (p - placement.center) * placement.scale;
        let (file, mut meshes) = exported(scene, placement);
        let mut shapes = file.all("shape");
        let mut open: Option<(&Node, Vec<DVec3>)> = None;
        for surface in scene.surfaces() {
            let Shape::Triangle(t) = &surface.shape else {
                let shape = shapes.next().unwrap();
                same_shape(shape, &surface.shape, &place);
                same_material(shape, &surface.material);
                continue;
            };
            if open.as_ref().is_none_or(|(_, rest)| rest.is_empty()) {
                let shape = shapes.next().unwrap();
                assert_eq!((shape.kind(), shape.get("face_normals")), ("obj", "true"));
                open = Some((shape, meshes.remove(shape.get("filename")).unwrap()));
            }
            let (shape, rest) = open.as_mut().unwrap();
            for (got, right) in rest.drain(..3).zip([t.a, t.b, t.c]) {
                near(got, place(right));
            }
            same_material(shape, &surface.material);
        }
        assert!(shapes.next().is_none() && meshes.is_empty() && open.is_none_or(|(_, rest)| rest.is_empty()));
        same_rays(file.all("sensor").next().unwrap(), scene, &place);
        let integrator = file.all("integrator").next().unwrap();
        assert_eq!((integrator.kind(), integrator.get("max_depth")), ("path", "$max_depth"));
        let default = |name: &str| file.get(name).to_owned();
        assert_eq!([default("max_depth"), default("rr_depth")], ["-1", "5"]);
        lights(&file, scene, &place, placement.scale);
    }
}

fn lights(file: &Node, scene: &Scene, place: &dyn Fn(DVec3) -> DVec3, scale: f64) {
    let mut emitters = file.all("emitter");
    for point in scene.points() {
        let emitter = emitters.next().unwrap();
        assert_eq!(emitter.kind(), "point");
        near(emitter.triple("position"), place(point.position));
        near(emitter.triple("intensity") / (scale * scale), point.intensity);
    }
    if let Some(Sky::Uniform { radiance }) = scene.sky() {
        let emitter = emitters.next().unwrap();
        assert_eq!((emitter.kind(), emitter.triple("radiance")), ("constant", *radiance));
    }
    assert!(emitters.next().is_none());
}

fn shapes() -> [Shape; 6] {
    let normal = at(0.36, -0.48, -0.8);
    let (axis, center) = (at(0.36, 0.48, 0.8), at(1.0, 2.0, -0.7));
    let ball = SpherePatch { center, radius: 0.3, axis, low: -1.0, high: 1.0, inward: false };
    let (a, b, c) = (at(0.1, 0.2, 0.3), at(1.0 / 3.0, 0.0, 2e-7), at(-0.4, 1e3, 0.9));
    [
        Shape::Rectangle(Rectangle { center, half_u: at(0.0, 0.7, 0.0), half_v: at(0.4, 0.0, 0.3) }),
        Shape::Disk(Disk { center, normal, radius: 0.6 }),
        Shape::Triangle(Triangle { a, b, c }),
        Shape::Triangle(Triangle { a, b: c, c: b }),
        Shape::Sphere(ball),
        Shape::Sphere(SpherePatch { radius: 30.0, inward: true, ..ball }),
    ]
}

fn materials() -> [Material; 6] {
    let (eta, k) = (at(0.2, 1.0 / 3.0, 1.5), at(3.9, 2.4, 0.0));
    let of = |bsdf| Material { bsdf, le: Rgb::ZERO };
    [
        Material::lambert(at(0.1, 0.2, 0.7), Rgb::ZERO),
        Material::lambert(at(0.1, 0.2, 0.7), at(1e-9, 0.0, 3e7)),
        of(Bsdf::Mirror { reflectance: at(0.9, 0.8, 1.0) }),
        of(Bsdf::Conductor { eta, k }),
        of(Bsdf::Dielectric { ior: 1.5 }),
        of(Bsdf::Glossy { alpha: 0.1, eta, k }),
    ]
}

const PROBE: Sensor = Sensor::Probe { origin: at(0.1, -0.2, 0.3), direction: at(0.6, 0.0, 0.8) };

#[test]
fn every_shape_of_every_material() {
    let surfaces = materials().map(|material| shapes().map(|shape| Surface::new(shape, material)));
    let points = [1.0, 7.0].map(|x| PointLight { position: at(x, 0.2, -3.0), intensity: at(x, 0.5, 0.0) });
    let sky = Sky::Uniform { radiance: at(0.3, 0.2, 0.1) };
    holds(&Scene::lit_by(surfaces.concat(), &points, Some(sky), PROBE));
}

#[test]
fn every_sensor() {
    let surfaces = shapes().map(|shape| Surface::new(shape, materials()[0])).to_vec();
    let (direction, up) = (at(0.2, -0.3, -1.0), at(0.1, 1.0, 0.0));
    let camera = |size| Camera::pinhole(at(0.3, 1.0, 5.0), direction, up, 70.0, size);
    let lens = Some(Lens { radius: 0.2, focus: 3.5 });
    let (half_u, half_v) = (at(0.0, 0.25, 0.0), at(0.0, 0.1, 0.5));
    for sensor in [
        Sensor::Camera(camera((5, 5))),
        Sensor::Camera(camera((7, 3))),
        Sensor::Camera(Camera { lens, ..camera((3, 4)) }),
        Sensor::Camera(Camera { near: 2.5, ..camera((4, 3)) }),
        Sensor::Camera(Camera { near: 2.5, lens, ..camera((4, 4)) }),
        Sensor::Parallel { center: at(2.0, 0.3, 0.1), direction: at(-0.8, 0.0, 0.6), half_u, half_v },
        Sensor::Parallel {
            center: at(2.0, 0.3, 0.1),
            direction: at(-0.8, 0.0, 0.6),
            half_u: half_v,
            half_v: half_u,
        },
    ] {
        holds(&Scene::new(surfaces.clone(), sensor));
    }
}

#[test]
fn every_scene_of_the_library() {
    let (albedo, emission, view) = (at(0.5, 0.2, 0.9), at(1.0, 0.3, 0.0), View::Probe);
    holds(&SceneKind::Furnace { albedo, emission, view }.build());
    holds(&SceneKind::FurnaceBox { albedo, emission, view }.build());
    holds(&SceneKind::CornellBox { resolution: 6 }.build());
    holds(&SceneKind::CornellEmpty { resolution: 5 }.build());
    let resolution = 5;
    for source in [Source::Square { half: 0.05 }, Source::Point] {
        holds(&SceneKind::Lecture(Lecture::CausticGlass { source, resolution }).build());
    }
    holds(&SceneKind::Lecture(Lecture::Indirect { resolution }).build());
    holds(&SceneKind::Lecture(Lecture::VeachMis { resolution }).build());
    holds(&SceneKind::Lecture(Lecture::Dof { aperture: 0.08, resolution }).build());
    holds(&SceneKind::Lecture(Lecture::Motion { travel: 0.0, resolution }).build());
    holds(&SceneKind::ManySpheres { count: 40, resolution }.build());
    for (tile, blocks) in (0..6).flat_map(|tile| [(tile, false), (tile, true)]) {
        holds(&SceneKind::CornellFlush { tile, blocks }.build());
    }
}

/// With `--scale` the middle of the scene is the origin.
#[test]
fn the_middle_goes_to_the_origin() {
    let scene = SceneKind::CornellFlush { tile: 0, blocks: true }.build();
    let placement = Placement::centred(&scene, 100.0);
    assert_eq!(placement, Placement { center: DVec3::splat(0.5), scale: 100.0 });
}

#[test]
fn what_mitsuba_cannot_have_is_refused() {
    let refuses = |scene: Scene, words: &str| {
        let why = export(&scene, Placement::SAME, "x").unwrap_err();
        assert!(why.contains(words), "{why}");
    };
    let [plate, _, triangle, _, Shape::Sphere(ball), _] = shapes() else { panic!() };
    let white = materials()[0];
    let one = |shape, material, sensor| Scene::new(vec![Surface::new(shape, material)], sensor);
    refuses(one(Shape::Sphere(SpherePatch { low: -0.5, ..ball }), white, PROBE), "no bands of a sphere");
    refuses(one(Shape::Sphere(SpherePatch { high: 0.5, ..ball }), white, PROBE), "no bands of a sphere");
    let moving = Surface::moving(triangle, white, at(0.0, 0.1, 0.0));
    refuses(Scene::new(vec![moving], PROBE), "moving surface");
    let irradiance = Sensor::Irradiance { point: DVec3::ZERO, normal: DVec3::Z, on: None };
    refuses(one(plate, white, irradiance), "irradiance");
    let along =
        Sensor::Parallel { center: DVec3::ZERO, direction: DVec3::X, half_u: DVec3::X, half_v: DVec3::Y };
    refuses(one(plate, white, along), "within their own rectangle");
    let camera = Camera::pinhole(DVec3::ZERO, DVec3::X, DVec3::Y, 40.0, (4, 4));
    refuses(one(plate, white, Sensor::Camera(Camera { width: 5, ..camera })), "squares");
    let clear = Material { le: Rgb::ONE, ..materials()[4] };
    refuses(one(plate, clear, PROBE), "clear interface");
    let lecture = |lecture: Lecture| SceneKind::Lecture(lecture).build();
    let (source, resolution) = (Source::Point, 4);
    refuses(lecture(Lecture::CausticMirror { source, resolution }), "no bands of a sphere");
    refuses(lecture(Lecture::Smallpt { resolution }), "no bands of a sphere");
    refuses(lecture(Lecture::Motion { travel: 0.5, resolution }), "moving surface");
    let sky = Sky::Cosine { radiance: Rgb::ONE, exponent: 1.0, up: DVec3::Z };
    refuses(Scene::lit_by(vec![Surface::new(plate, white)], &[], Some(sky), PROBE), "cosine");
}

/// `experiment export ARGS` in an empty folder: exit status, standard output, standard error, files.
fn run(args: &[&str]) -> (Option<i32>, String, String, HashMap<String, String>) {
    let place = tempfile::tempdir().unwrap();
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.arg("export").args(args).current_dir(place.path()).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let files = std::fs::read_dir(place.path()).unwrap().map(|entry| {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, std::fs::read_to_string(path).unwrap())
    });
    (output.status.code(), text(output.stdout), text(output.stderr), files.collect())
}

#[test]
fn the_command_writes_the_scene() {
    let (status, stdout, _, files) = run(&["cornell_box", "--format", "mitsuba", "--resolution", "7"]);
    assert_eq!((status, files.len()), (Some(0), 0));
    let scene = SceneKind::CornellBox { resolution: 7 }.build();
    assert_eq!(stdout, export(&scene, Placement::SAME, "").unwrap().xml);
    let (status, stdout, _, files) =
        run(&["cornell_flush", "--tile", "6", "--blocks", "--scale", "100", "-o", "flush.xml"]);
    assert_eq!((status, stdout.as_str(), files.len()), (Some(0), "", 3));
    let scene = SceneKind::CornellFlush { tile: 5, blocks: true }.build();
    let right = export(&scene, Placement::centred(&scene, 100.0), "flush").unwrap();
    assert_eq!(files["flush.xml"], right.xml);
    right.meshes.iter().for_each(|mesh| assert_eq!(files[&mesh.name], mesh.text));
}

/// Whatever the file is called, its meshes are found.
#[test]
fn names_are_escaped() {
    let file = "a & b < \"c\" > 'd' ü &amp;.xml";
    let (status, _, stderr, files) = run(&["cornell_flush", "--blocks", "-o", file]);
    assert_eq!((status, files.len()), (Some(0), 3), "{stderr}");
    let roots = read(&mut files[file].as_str());
    let meshes: Vec<&Node> = roots[0].all("shape").filter(|s| s.kind() == "obj").collect();
    assert_eq!(meshes.len(), 2);
    meshes.iter().for_each(|mesh| assert!(files.contains_key(mesh.get("filename"))));
}

#[test]
fn the_command_refuses_in_one_sentence() {
    let cases: [(&[&str], &str); 11] = [
        (&["integrating_sphere"], "integrating_sphere: Mitsuba has no bands of a sphere"),
        (&["kitchen"], "no scene `kitchen`; there are cornell_box, cornell_empty, cornell_flush"),
        (&["furnace", "--tile", "2"], "furnace has no --tile"),
        (&["cornell_box", "--blocks"], "cornell_box has no --blocks"),
        (&["cornell_flush", "--resolution", "8"], "cornell_flush has no --resolution"),
        (&["cornell_flush", "--tile", "7"], "not in 1..=6"),
        (&["cornell_flush", "--blocks"], "triangles, which go into files beside it"),
        (&["cornell_flush", "--blocks", "-o", "a$b.xml"], "cannot hold '$'; rename the file"),
        (&["cornell_box", "-o", "box.json"], "box.json must be a name in Unicode that ends in .xml"),
        (&["cornell_box", "-o", "nowhere/box.xml"], "cannot write nowhere/box.xml"),
        (&["cornell_box", "--scale", "0"], "it must be finite and positive"),
    ];
    for (args, words) in cases {
        let (status, stdout, stderr, files) = run(args);
        assert_eq!((status, stdout.as_str(), files.len()), (Some(2), "", 0), "{args:?}: {stderr}");
        assert!(stderr.starts_with("error: ") && stderr.contains(words), "{args:?}: {stderr}");
    }
}

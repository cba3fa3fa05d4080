//! A view, measured: every setting of every method against full resolution, with each number of samples, on every machine.

use super::costs::{costs, simulated};
use super::draw::{Converging, Subject, difference, luminance};
use super::host::{Timed, host_times};
use super::plan::{ErrorTimePlan, Setting};
use super::row::{BuildTime, Measured};
use super::stage::{Cameras, Stage};
use crate::format::Scene;
use crate::mesh::FinestSurface;
use crate::method::{Method, Over, find, packet, reference};
use crate::picture::{Frame, FullResolution, PictureError, Shader, SurfaceError, error_map, level_map, render, sampled, save_png};
use crate::rays::{Camera, ModelSpace, Sight};
use crate::report::error_time::{Appearance, Converged, PictureEntry, Point, SceneEntry, Shift, TraceGrid, ViewEntry};
use crate::report::result::SimResult;
use crate::report::{inspect, plain_name};
use crate::study::{Cache, Chosen, Progress, Shot, StudyError, ViewJob, at_once, busy};
use image::RgbImage;
use std::path::Path;
use std::time::Instant;

/// The name of full resolution among pictures.
const FULL: &str = "full";
/// Pictures are kept with at most so many samples along a side of a pixel.
const MOST_KEPT: u32 = 4;

/// A scene with everything that measuring it needs.
pub struct Bench<'a> {
    pub(super) plan: &'a ErrorTimePlan,
    pub(super) scene: &'a Scene,
    pub(super) space: ModelSpace,
    pub(super) cache: &'a Cache,
    pub(super) progress: &'a dyn Progress,
    facts: SceneEntry,
    /// The scene's file, as commands name it; empty if it was generated.
    path: String,
    methods: Vec<(Chosen, Box<dyn Method>)>,
    builds: Vec<BuildTime>,
    /// Full resolution: the input where that is at hand, else the finest level.
    truth: Truth<'a>,
    /// The finest level, where full resolution is another.
    finest: Option<Truth<'a>>,
}

/// A surface that errors are against.
pub(super) struct Truth<'a> {
    scene: &'a Scene,
    space: ModelSpace,
    reference: Box<dyn Method>,
    surface: FinestSurface,
}

impl<'a> Truth<'a> {
    /// All triangles of a scene.
    fn of(scene: &'a Scene, cache: &Cache, progress: &dyn Progress) -> Result<Self, StudyError> {
        Ok(Self {
            scene,
            space: ModelSpace::of(scene),
            reference: Chosen::plain(&reference::METHOD).make(scene, cache, progress)?.0,
            surface: busy(progress, "full-resolution surface", || FinestSurface::new(&scene.decode())),
        })
    }

    /// What each pixel's ray meets of it.
    fn frame(&self, camera: &Camera) -> Frame {
        render(&*self.reference, &self.space, camera, f64::INFINITY, &|| ()).0
    }

    /// How far a stage's frame is from it.
    fn errors(&self, of: &Scene, frame: &Frame, truth: &Frame, camera: &Camera, stride: u32) -> SurfaceError {
        let full = FullResolution { scene: self.scene, space: &self.space, surface: &self.surface, pixels: &truth.pixels };
        SurfaceError::of(of, &frame.pixels, &full, camera, stride)
    }
}

/// A setting's picture, and what it cost.
pub(super) struct Seen {
    picture: RgbImage,
    luminance: Vec<f32>,
    /// Against full resolution with the same samples.
    pub errors: PictureError,
    /// On every machine.
    pub results: Vec<SimResult>,
}

/// A setting's surface.
pub(super) struct Surface {
    pub errors: SurfaceError,
    frame: Frame,
}

/// A setting with its picture's errors still to be compared with the converged picture.
struct Unseen {
    point: usize,
    picture: RgbImage,
    luminance: Vec<f32>,
}

impl<'a> Bench<'a> {
    /// Builds what the methods need.
    pub fn new(
        plan: &'a ErrorTimePlan,
        scene: &'a Scene,
        (facts, path): (SceneEntry, String),
        (cache, progress): (&'a Cache, &'a dyn Progress),
    ) -> Result<Self, StudyError> {
        let (mut methods, mut builds) = (Vec::new(), Vec::new());
        for chosen in &plan.jobs.methods {
            if chosen.method.of_input() && scene.input().is_none() {
                continue;
            }
            let begun = Instant::now();
            let (method, from_cache) = chosen.make(scene, cache, progress)?;
            let seconds = begun.elapsed().as_secs_f64();
            builds.push(BuildTime { method: chosen.method.name.to_owned(), seconds, from_cache });
            methods.push((chosen.clone(), method));
        }
        Ok(Self {
            plan,
            scene,
            space: ModelSpace::of(scene),
            cache,
            progress,
            facts,
            path,
            methods,
            builds,
            truth: Truth::of(scene.input().unwrap_or(scene), cache, progress)?,
            finest: scene.input().map(|_| Truth::of(scene, cache, progress)).transpose()?,
        })
    }

    /// Measures a view; pictures go to `folder`, their names begin with `prefix`. What is simulated is the whole frame; errors and pictures are of some of its
    /// columns and rows.
    pub fn view(&self, view: &ViewJob, folder: &Path, prefix: &str, sizes: bool) -> Result<Measured, StudyError> {
        let frame = view.camera(&self.space)?;
        let few = frame.every(self.plan.measure.every(view.size));
        let subject = self.subject();
        let told = ("full resolution", self.progress);
        let truth = Shot::of(&*self.truth.reference, &subject.shader, &self.truth.space, [&few; 2], f64::INFINITY, told);
        let finest = self.finest.as_ref().map(|finest| (finest, finest.frame(&few)));
        let settings = self.settings(&frame)?;
        let surfaces: Vec<_> = settings.iter().map(|of| self.setting_surface(of, &few, &truth.frame)).collect();
        let mut book = PictureBook { folder, prefix, entries: Vec::new() };
        let (mut points, mut shift, mut unseen) = (Vec::new(), Vec::new(), Vec::new());
        let ppd = self.plan.measure.pixels_per_degree;
        let kept = self.plan.sides.iter().copied().filter(|&side| side <= MOST_KEPT).max();
        for &side in &self.plan.sides {
            let cameras = Cameras { frame: frame.with_samples(side)?.in_turn(view.tiles_in_turn), few: few.with_samples(side)? };
            let samples = side * side;
            let full = match side {
                1 => truth.image.clone(),
                _ => subject.draw(&*self.truth.reference, &cameras.few, f64::INFINITY, "full resolution").image(),
            };
            let moved = cameras.few.shifted([0.5, 0.5]);
            let shifted = subject.draw(&*self.truth.reference, &moved, f64::INFINITY, "shifted by half a pixel").image();
            shift.push(Shift { samples, picture: PictureError::of(&shifted, &full, ppd) });
            if kept == Some(side) {
                book.add(&full, FULL, "full resolution", samples, "image")?;
            }
            let bar = self.progress.begin("settings", Some(settings.len() as u64));
            let seen = at_once(&settings, |(at, setting)| {
                let seen = self.seen(&self.stage(*at, setting), &cameras, &full);
                bar.step(1);
                seen
            });
            drop(bar);
            let seen = seen.into_iter().collect::<Result<Vec<_>, StudyError>>()?;
            for (((at, setting), surface), Seen { picture, luminance, errors, results }) in settings.iter().zip(&surfaces).zip(seen) {
                if kept == Some(side) && setting.is_default {
                    let name = setting.chosen.method.name;
                    book.add(&picture, name, &setting.words, samples, "image")?;
                    book.add(&error_map(&picture, &full), name, &setting.words, samples, "error")?;
                    if setting.has_levels() {
                        book.add(&level_map(&surface.frame), name, &setting.words, 1, "levels")?;
                    }
                }
                let point = self.point(&setting.words, samples, &results, errors, surface.errors)?;
                let of_finest = finest.as_ref().filter(|_| setting.chosen.method.over == Over::Scene);
                let own = self.method(*at, setting).surface(self.scene);
                let of_finest = of_finest.map(|(finest, truth)| finest.errors(own, &surface.frame, truth, &few, self.plan.measure.stride));
                points.push(Point { is_default: setting.is_default, finest: of_finest, ..point });
                if self.plan.measure.most_samples > 0 {
                    unseen.push(Unseen { point: points.len() - 1, picture, luminance });
                }
            }
        }
        let converged = self.converged(&few, &mut points, &unseen)?;
        Ok(Measured {
            scene: self.facts.clone(),
            view: ViewEntry {
                scene: 0,
                distance: frame.radii,
                eye: frame.eye.to_array(),
                size: view.size,
                every: few.stride,
                converged,
                shift,
            },
            points,
            pictures: book.entries,
            traces: self.traces(&frame, &settings),
            host: self.host(&frame, &settings),
            builds: self.builds.clone(),
            left_out: self.left_out(&Cameras { frame: frame.in_turn(view.tiles_in_turn), few }, &truth.image, &truth.frame)?,
            sizes: if sizes { self.sizes(view)? } else { Vec::new() },
        })
    }

    /// The method of a setting.
    fn method<'b>(&'b self, at: usize, setting: &'b Setting) -> &'b dyn Method {
        setting.method.as_deref().unwrap_or(&*self.methods[at].1)
    }

    fn subject(&self) -> Subject<'_> {
        Subject {
            progress: self.progress,
            shader: Shader::new(self.truth.scene, &self.truth.space, self.plan.measure.shading),
            space: &self.truth.space,
        }
    }

    /// What each method does if nothing is chosen, with its number.
    pub(super) fn defaults(&self, camera: &Camera) -> Vec<(usize, Setting)> {
        let of = |(at, (base, method)): (usize, &(Chosen, Box<dyn Method>))| {
            (at, Setting::usual(base, &**method, |delta| Sight::new(camera, &self.space, delta)))
        };
        self.methods.iter().enumerate().map(of).collect()
    }

    /// All settings, with the number of their method.
    fn settings(&self, camera: &Camera) -> Result<Vec<(usize, Setting)>, StudyError> {
        let of = |(at, (base, method)): (usize, &(Chosen, Box<dyn Method>))| {
            let settings = self.plan.settings(base, &**method, |delta| Sight::new(camera, &self.space, delta))?;
            Ok(settings.into_iter().map(|setting| (at, setting)).collect::<Vec<_>>())
        };
        Ok(self.methods.iter().enumerate().map(of).collect::<Result<Vec<_>, StudyError>>()?.into_iter().flatten().collect())
    }

    pub(super) fn stage<'b>(&'b self, at: usize, setting: &'b Setting) -> Stage<'b> {
        let (chosen, targets) = (&setting.chosen, &self.plan.jobs.targets);
        // Truth is the input wherever a method is over it.
        let (scene, space) = if chosen.method.of_input() { (self.truth.scene, &self.truth.space) } else { (self.scene, &self.space) };
        let method = self.method(at, setting);
        Stage { scene, all: method.surface(scene), space, chosen, method, targets }
    }

    /// What a stage's frame costs on the machines, and its picture, whose errors are against `full`.
    pub(super) fn seen(&self, stage: &Stage<'_>, cameras: &Cameras, full: &RgbImage) -> Result<Seen, StudyError> {
        let &Stage { all, space, chosen, method, .. } = stage;
        let shader = Shader::new(all, space, self.plan.measure.shading);
        let drawn = sampled(method, &shader, space, &cameras.few, chosen.delta(), &|| ());
        let picture = drawn.image();
        Ok(Seen {
            luminance: if self.plan.measure.most_samples > 0 { luminance(&drawn) } else { Vec::new() },
            errors: PictureError::of(&picture, full, self.plan.measure.pixels_per_degree),
            picture,
            results: simulated(stage, &cameras.frame, self.plan.turning)?,
        })
    }

    /// The triangles that a method is over.
    fn triangles(&self, method: &str) -> u64 {
        let is_truth = find(method).is_some_and(|method| method.over != Over::Scene);
        if is_truth { self.truth.scene.finest_triangles() } else { self.facts.finest_triangles }
    }

    /// What was measured of a setting with so many samples.
    pub(super) fn point(
        &self,
        words: &str,
        samples: u32,
        results: &[SimResult],
        picture: PictureError,
        geometry: SurfaceError,
    ) -> Result<Point, StudyError> {
        let facts = &results.first().ok_or(StudyError::NoMachine)?.setup.method;
        Ok(Point {
            view: 0,
            method: facts.name.clone(),
            setting: words.to_owned(),
            is_default: false,
            knobs: facts.knobs.clone(),
            choices: facts.choices.clone(),
            samples,
            bytes: facts.bytes,
            bytes_per_triangle: facts.bytes as f64 / self.triangles(&facts.name) as f64,
            geometry,
            finest: None,
            picture,
            viewed: None,
            appearance: None,
            costs: results.iter().enumerate().map(|(machine, result)| costs(machine, result)).collect(),
        })
    }

    /// The surface of a setting, by one ray a pixel, as more would see the same.
    fn setting_surface(&self, (at, setting): &(usize, Setting), few: &Camera, truth: &Frame) -> Surface {
        self.surface(&self.stage(*at, setting), few, truth)
    }

    /// What the rays of a stage meet, held against full resolution.
    pub(super) fn surface(&self, stage: &Stage<'_>, few: &Camera, truth: &Frame) -> Surface {
        let bar = self.progress.begin("surface", Some(u64::from(few.height)));
        let frame = render(stage.method, stage.space, few, stage.chosen.delta(), &|| bar.step(1)).0;
        drop(bar);
        Surface { errors: self.truth.errors(stage.all, &frame, truth, few, self.plan.measure.stride), frame }
    }

    /// Draws full resolution with more and more samples until its standard error is a quarter of the smallest error, or there are no more; then says how
    /// far every picture is from it. None if none is wanted.
    fn converged(&self, camera: &Camera, points: &mut [Point], unseen: &[Unseen]) -> Result<Option<Converged>, StudyError> {
        let most = self.plan.measure.most_samples;
        let subject = self.subject();
        if most == 0 {
            return Ok(None);
        }
        let mut side = self.plan.least_converged();
        loop {
            let Converging { picture: drawn, standard_error } = subject.converging(&*self.truth.reference, camera, side)?;
            let picture = drawn.image();
            let errors = unseen.iter().map(|unseen| difference(&unseen.picture, &picture));
            let smallest = errors.filter(|&error| error > 0.0).fold(f64::INFINITY, f64::min);
            // Twice as many along a side, if the picture's size allows that.
            if standard_error > 0.25 * smallest && 2 * side <= most && camera.with_samples(side).is_ok() {
                side *= 2;
                continue;
            }
            let bright = luminance(&drawn);
            for unseen in unseen {
                points[unseen.point].appearance = Appearance::of(&unseen.luminance, &bright);
                points[unseen.point].viewed = Some(PictureError::of(&unseen.picture, &picture, self.plan.measure.pixels_per_degree));
            }
            return Ok(Some(Converged { samples: side * side, standard_error }));
        }
    }

    /// The steps of a grid of rays of each method, with the setting that it has by default; none of packets, which have no steps of one ray.
    fn traces(&self, camera: &Camera, settings: &[(usize, Setting)]) -> Vec<TraceGrid> {
        // A scene that was generated has no file: commands name the one that it would be written to.
        let file = if self.path.is_empty() { format!("{}.lod", plain_name(&self.facts.name)) } else { self.path.clone() };
        let grid = |(at, setting): &(usize, Setting)| {
            let subject = inspect::Subject {
                scene: self.scene,
                file: &file,
                registered: setting.chosen.method,
                method: self.method(*at, setting),
                delta: setting.chosen.delta(),
                camera,
            };
            TraceGrid { setting: setting.words.clone(), ..inspect::rays(&subject, [self.plan.trace_grid(); 2]) }
        };
        settings.iter().filter(|(_, setting)| setting.is_default && packet::chosen(&setting.chosen.knobs) == 1).map(grid).collect()
    }

    fn host(&self, camera: &Camera, settings: &[(usize, Setting)]) -> Vec<super::row::HostTime> {
        let most = self.plan.measure.host_rays;
        if most == 0 {
            return Vec::new();
        }
        let timed = settings.iter().map(|(at, setting)| Timed {
            name: setting.chosen.method.name,
            words: &setting.words,
            method: self.method(*at, setting),
            delta: setting.chosen.delta(),
        });
        let timed: Vec<_> = timed.collect();
        busy(self.progress, "host times", || host_times(&timed, camera, &self.space, most))
    }
}

/// The pictures of a view.
struct PictureBook<'a> {
    folder: &'a Path,
    prefix: &'a str,
    entries: Vec<PictureEntry>,
}

impl PictureBook<'_> {
    fn add(&mut self, picture: &RgbImage, method: &str, setting: &str, samples: u32, kind: &str) -> Result<(), StudyError> {
        let file = format!("{}-{method}-{kind}.png", self.prefix);
        let path = self.folder.join(&file);
        save_png(picture, &[], &path).map_err(|source| StudyError::Picture { path, source })?;
        let [method, setting, kind] = [method, setting, kind].map(str::to_owned);
        self.entries.push(PictureEntry { view: 0, method, setting, samples, kind, file });
        Ok(())
    }
}

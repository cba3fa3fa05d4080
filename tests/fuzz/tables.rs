//! Descriptions in TOML: machines with their memories and energies, scenes of paths, plans.

use super::damage::File;
use super::round::{Limit, folder, round};
use lodray::hardware::Hardware;
use lodray::machine::Machine;
use lodray::paths::SceneFile;
use lodray::plan::Plan;
use lodray::run::{self, Compute};
use lodray::sim::dram::Device;
use std::fs;
use std::path::Path;

fn shipped(folder: &str) -> Vec<File> {
    File::of(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), "toml")
}

/// True for what was read; an error has to be in words, and may show the line.
fn is_read<T, E: std::fmt::Display>(read: Result<T, E>) -> bool {
    read.map_err(|error| assert!(error.to_string().len() > 10, "{error}")).is_ok()
}

const LIMIT: Limit = Limit { bytes: 1 << 20, each: 300 };

#[test]
fn machines() {
    let path = folder().join("machine.toml");
    round(
        "machines",
        || shipped("machines"),
        LIMIT,
        |bytes| {
            fs::write(&path, bytes).unwrap();
            let machine = Machine::load(&path);
            if let Ok(machine) = &machine {
                for compute in [Compute::Free, Compute::Units] {
                    _ = is_read(run::check(machine, compute));
                }
            }
            is_read(machine)
        },
    );
}

#[test]
fn memories() {
    round(
        "memories",
        || shipped("machines/dram"),
        LIMIT,
        |bytes| {
            let device = Device::from_toml(&String::from_utf8_lossy(bytes));
            if let Ok(device) = &device {
                assert!(device.banks() > 0 && device.peak_bytes_per_second() > 0.0);
            }
            is_read(device)
        },
    );
}

/// A table of energies in the place of the one that the paper's machine names.
fn energies(reader: &str, file: &str) {
    let folder = tempfile::tempdir().unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("machines");
    let machine = folder.path().join("machine.toml");
    fs::copy(shipped.join("haydel2023.toml"), &machine).unwrap();
    fs::create_dir(folder.path().join("energy")).unwrap();
    let corpus = || vec![File::new(file, fs::read(shipped.join("energy").join(file)).unwrap())];
    round(reader, corpus, LIMIT, |bytes| {
        fs::write(folder.path().join("energy").join(file), bytes).unwrap();
        is_read(run::check(&Machine::load(&machine).unwrap(), Compute::Units))
    });
}

#[test]
fn energies_of_caches() {
    energies("energies-of-caches", "cacti22.toml");
}

#[test]
fn energies_of_geometries() {
    energies("energies-of-geometries", "cacti22.csv");
}

#[test]
fn energies_of_blocks() {
    energies("energies-of-blocks", "blocks22.toml");
}

#[test]
fn scenes_of_paths() {
    round(
        "scenes-of-paths",
        || shipped("scenes"),
        LIMIT,
        |bytes| {
            let scene = SceneFile::parse(&String::from_utf8_lossy(bytes), "scene.toml");
            if let Ok(scene) = &scene {
                assert!(scene.camera(None).is_some() && !scene.model.is_empty());
                assert!(scene.model.iter().all(|model| !scene.materials(model).is_empty()));
            }
            is_read(scene)
        },
    );
}

#[test]
fn plans() {
    round(
        "plans",
        || File::all("plan", "toml"),
        LIMIT,
        |bytes| {
            let plan: Result<Plan, _> = toml::from_str(&String::from_utf8_lossy(bytes));
            let Ok(plan) = plan else { return is_read(plan) };
            let possible = plan.possible();
            if possible.is_ok() {
                let hardware = plan.hardware(&Hardware::default());
                assert!(
                    hardware.stack_entries() > 0
                        && plan.scenes.iter().all(|name| plan.job(name).is_none_or(|job| !job.views.is_empty() || !job.regions.is_empty()))
                );
            }
            is_read(possible)
        },
    );
}

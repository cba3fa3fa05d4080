//! `include/lodray.h` is what the declarations print, and is C as well as C++.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Files of declarations, in the header's order.
const SOURCES: [&str; 9] = ["error", "scene", "ports", "config", "rays", "cast", "golden", "unit", "bits"];

fn crate_folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn header_file() -> PathBuf {
    crate_folder().join("../include/lodray.h")
}

/// The header of the declarations as they are.
fn printed() -> String {
    let config = cbindgen::Config::from_file(crate_folder().join("cbindgen.toml")).unwrap();
    let sources = SOURCES.map(|name| crate_folder().join(format!("src/{name}.rs")));
    let builder = sources.iter().fold(cbindgen::Builder::new().with_config(config), cbindgen::Builder::with_src);
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    // Rust calls it safety what a caller must see to; C has no word for it.
    String::from_utf8(text).unwrap().replace("//\n// # Safety\n// ", "//\n// Needs: ")
}

#[test]
fn the_header_is_what_the_declarations_print() {
    let printed = printed();
    if std::env::var_os("LODRAY_REWRITE_HEADER").is_some() {
        std::fs::write(header_file(), &printed).unwrap();
    }
    let stands = std::fs::read_to_string(header_file()).unwrap();
    assert!(stands == printed, "include/lodray.h is not what c/src declares: run scripts/header");
}

#[test]
fn every_exported_function_is_in_the_header() {
    let folder = crate_folder().join("src");
    let texts = std::fs::read_dir(folder).unwrap().map(|entry| std::fs::read_to_string(entry.unwrap().path()).unwrap());
    let all: String = texts.collect();
    let exported = all.split("extern \"C\" fn ").skip(1).map(|rest| rest.split('(').next().unwrap());
    let printed = printed();
    let missing: Vec<_> = exported.clone().filter(|name| !printed.contains(&format!("{name}("))).collect();
    assert!(missing.is_empty() && exported.count() > 25, "{missing:?}");
    assert_eq!(all.matches("#[unsafe(no_mangle)]").count(), all.matches("extern \"C\" fn ").count());
}

#[test]
fn c_and_cpp_compilers_take_it_without_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lodray.h"), printed()).unwrap();
    for (compiler, file, standard) in [("cc", "only.c", "-std=c99"), ("c++", "only.cpp", "-std=c++11")] {
        let file = folder.path().join(file);
        std::fs::write(&file, "#include \"lodray.h\"\n#include \"lodray.h\"\ntypedef int nothing;\n").unwrap();
        let out = Command::new(compiler)
            .args([standard, "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only"])
            .arg(&file)
            .output()
            .unwrap();
        assert!(out.status.success(), "{compiler}: {}", String::from_utf8_lossy(&out.stderr));
    }
}

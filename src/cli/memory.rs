//! Whether there is memory for a scene that is to be made.

/// Refuses what this machine has no memory for, where it says how much it has: an allocation that fails ends the program on the spot. `instead` is what to do about it.
pub fn check_memory(levels: u32, triangles: u64, bytes_per_triangle: u64, instead: &str) -> anyhow::Result<()> {
    let needed = triangles * bytes_per_triangle;
    let Some(available) = available_memory() else { return Ok(()) };
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    anyhow::ensure!(
        needed <= available,
        "--levels {levels}: this scene needs about {:.1} GB of memory, {:.1} GB are free; {instead}",
        gigabytes(needed),
        gigabytes(available)
    );
    Ok(())
}

fn available_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

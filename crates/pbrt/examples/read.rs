//! Parses the scene files given as arguments and prints what is in them.

fn main() {
    let mut failed = false;
    for path in std::env::args().skip(1) {
        match tyndall_pbrt::parse_file(&path) {
            Ok(scene) => {
                println!(
                    "{path}: {} directives, {} parameters",
                    scene.directives.len(),
                    scene.inventory.len()
                );
                for diagnostic in scene.diagnostics.to_vec() {
                    println!("{diagnostic}");
                }
            }
            Err(error) => {
                failed = true;
                eprintln!("{:?}", miette::Report::new(error));
            }
        }
    }
    std::process::exit(if failed { 2 } else { 0 });
}

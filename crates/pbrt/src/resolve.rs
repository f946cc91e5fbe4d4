//! File names of a scene to files on this machine.

use std::path::{Path, PathBuf};

use crate::text::Text;

/// Finds the files that a scene names: relative to the folder of the main scene file, as pbrt-v4 does, and failing
/// that beside the file that names it, then in the working directory. Backslashes of Windows are understood, and a
/// path with a drive letter is looked for under the scene's folder by its last parts.
#[derive(Clone, Debug, Default)]
pub struct Resolver {
    scene_dir: PathBuf,
}

/// A file found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// Where it is.
    pub path: PathBuf,
    /// How it was found, if not at the place that pbrt-v4 would look first.
    pub note: Option<String>,
}

/// The places where a file is not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotFound {
    /// All paths that were looked at.
    pub tried: Vec<PathBuf>,
}

impl NotFound {
    /// The paths in one line, the first few of them.
    pub fn list(&self) -> String {
        let shown: Vec<String> = self.tried.iter().take(4).map(|p| p.display().to_string()).collect();
        let more = self.tried.len().saturating_sub(shown.len());
        if more > 0 { format!("{} and {more} more", shown.join(", ")) } else { shown.join(", ") }
    }
}

impl Resolver {
    /// Looks in the folder of the main scene file.
    pub fn new(scene_dir: impl Into<PathBuf>) -> Resolver {
        Resolver { scene_dir: scene_dir.into() }
    }

    /// The folder of the main scene file.
    pub fn scene_dir(&self) -> &Path {
        &self.scene_dir
    }

    /// Finds a file named in a scene file that lies in the folder `beside`.
    ///
    /// # Errors
    /// The paths that were tried if there is no file at any.
    pub fn find(&self, name: &Text, beside: Option<&Path>) -> Result<Found, NotFound> {
        let candidates = self.candidates(name, beside);
        let at = candidates.iter().position(|(path, _)| path.is_file());
        match at.map(|i| candidates[i].clone()) {
            Some((path, how)) => {
                let note = how.map(|how| format!("found {} {how}", path.display()));
                Ok(Found { path, note })
            }
            None => Err(NotFound { tried: candidates.into_iter().map(|(path, _)| path).collect() }),
        }
    }

    /// All paths to look at, best first, with how each differs from pbrt's own rule.
    fn candidates(&self, name: &Text, beside: Option<&Path>) -> Vec<(PathBuf, Option<&'static str>)> {
        let mut paths: Vec<(PathBuf, Option<&'static str>)> = Vec::new();
        let mut add = |path: PathBuf, how| {
            if !paths.iter().any(|(p, _)| *p == path) {
                paths.push((path, how));
            }
        };
        let slashed = name.raw().replace("\\\\", "/").replace('\\', "/");
        let spellings = [(name.as_str(), None), (slashed.as_str(), Some("(backslashes read as `/`)"))];
        for (spelling, how) in spellings {
            add(self.scene_dir.join(spelling), how);
            if let Some(dir) = beside {
                add(dir.join(spelling), how.or(Some("beside the file that names it")));
            }
            add(PathBuf::from(spelling), how.or(Some("in the working directory")));
        }
        for tail in windows_tails(&slashed) {
            let how = Some("for a path of another machine");
            add(self.scene_dir.join(tail), how);
            if let Some(dir) = beside {
                add(dir.join(tail), how);
            }
        }
        paths
    }
}

/// For `C:/a/b/c.png`: `a/b/c.png`, `b/c.png`, `c.png`; nothing for paths without drive letter or server name.
fn windows_tails(path: &str) -> impl Iterator<Item = &str> {
    let bytes = path.as_bytes();
    let drive = bytes.len() > 2 && bytes[0].is_ascii_alphabetic() && bytes[1] == b':' && bytes[2] == b'/';
    let starts = path.match_indices('/').map(move |(i, _)| &path[i + 1..]);
    starts.filter(move |tail| drive && !tail.is_empty()).take(32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::span::Span;

    fn text(raw: &str) -> Text {
        Text::unquote(raw.as_bytes(), raw.contains('\\'), Span::default()).0
    }

    #[test]
    fn finds_files_by_every_spelling() {
        let dir = tempfile::tempdir().unwrap();
        let geo = dir.path().join("geo");
        std::fs::create_dir_all(geo.join("new")).unwrap();
        let wood = geo.join("new").join("wood.png");
        std::fs::write(&wood, b"x").unwrap();
        let resolver = Resolver::new(dir.path());
        let found = |raw: &str, beside: Option<&Path>| resolver.find(&text(raw), beside);

        let plain = found("geo/new/wood.png", None).unwrap();
        assert_eq!(plain, Found { path: wood.clone(), note: None });
        for raw in [r"geo\new\wood.png", r"geo\\new\\wood.png", r"D:\jobs\geo\new\wood.png"] {
            let found = found(raw, None).unwrap();
            assert_eq!(found.path, wood, "{raw}");
            assert!(found.note.is_some(), "{raw}");
        }
        let beside = found("new/wood.png", Some(&geo)).unwrap();
        assert!(beside.note.unwrap().contains("beside"));
        assert_eq!(found(wood.to_str().unwrap(), None).unwrap().note, None);
        let missing = found("none.png", Some(&geo)).unwrap_err();
        assert_eq!(missing.tried.len(), 3);
    }
}

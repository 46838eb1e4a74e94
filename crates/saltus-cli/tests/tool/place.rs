//! A folder with a scene that is swept, in the tests of sweeps.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use tempfile::TempDir;

pub(crate) const DROP: &str = "restitution = 0.5\n[ball]\nheight = \"1 m\"\n";
pub(crate) const DRAG: &str =
    "restitution = 0.8\nball = { height = \"1 m\" }\ndrag = { per_length = 0.05 }\nrun = { until = \"10 s\" }\n";

/// A scene in a folder of its own.
pub(crate) struct Place(pub(crate) TempDir);

impl Place {
    pub(crate) fn of(scene: &str) -> Self {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("scene.toml"), scene).unwrap();
        Self(folder)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The sweep of the scene, called in its folder.
    pub(crate) fn sweep(&self) -> Command {
        let mut command = super::saltus();
        command.args(["sweep", "scene.toml"]).current_dir(self.0.path());
        command
    }
}

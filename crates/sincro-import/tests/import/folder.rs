//! A temporary folder with robot files.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use sincro_import::{ElementStatus, Entry, Imported, Options, import};
use sincro_scene::diagnostic::Diagnostics;
use sincro_scene::fmu::Loaders;
use sincro_scene::open::{Opened, open};

/// A folder that is removed at the end of a test.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("sincro-import-test-{}-{count}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file and returns its path.
    pub fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path
    }

    /// Imports a text as a file of that name.
    pub fn import(&self, name: &str, text: &str) -> Result<Imported, Diagnostics> {
        self.import_with(name, text, &Options::default())
    }

    pub fn import_with(&self, name: &str, text: &str, options: &Options) -> Result<Imported, Diagnostics> {
        import(&self.file(name, text), options)
    }

    /// Writes an imported scene and opens it.
    pub fn open(&self, imported: &Imported) -> Opened {
        let scene = self.0.join("scene");
        imported.write(&scene).unwrap();
        open(&scene, &[], Loaders::default(), true).unwrap_or_else(|found| panic!("{found}\n{}", imported.scene()))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The entry of the report whose element ends so.
pub fn entry<'a>(imported: &'a Imported, ending: &str) -> &'a Entry {
    let found = imported.report.elements.iter().find(|e| e.element.ends_with(ending));
    found.unwrap_or_else(|| panic!("no entry `{ending}`: {:#?}", imported.report.elements))
}

/// Entries that are dropped and not inside another one.
pub fn dropped(imported: &Imported) -> Vec<String> {
    let of = imported.report.elements.iter().filter(|e| e.status == ElementStatus::Dropped && !e.inside);
    of.map(|e| e.element.clone()).collect()
}

/// Binary STL of a tetrahedron with edges of 1 along the axes.
pub fn tetrahedron() -> Vec<u8> {
    let p: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bytes = vec![0; 80];
    bytes.extend(4_u32.to_le_bytes());
    for t in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] {
        bytes.extend([0; 12]);
        t.iter().for_each(|k: &usize| p[*k].iter().for_each(|x| bytes.extend(x.to_le_bytes())));
        bytes.extend([0; 2]);
    }
    bytes
}

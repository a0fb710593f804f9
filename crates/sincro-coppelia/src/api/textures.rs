//! Textures of shapes. They are kept and told again; vision sensors and the viewer show the colours of shapes.

use std::path::{Path, PathBuf};

use sincro_vision::textures::Texture;

use super::registry::{Handle, Kind};
use super::shapes::primitive_of;
use super::{ApiError, SimApi};

/// Largest file of a picture [bytes].
const MAX_FILE: u64 = 32 << 20;

impl SimApi<'_> {
    /// Bytes of a picture file in the scene's folder. Of a whole path of another computer its ends are looked for.
    ///
    /// # Errors
    ///
    /// There is none, it lies elsewhere, or it is too large.
    pub(super) fn picture_file(&self, name: &str) -> Result<Vec<u8>, ApiError> {
        let short: String = name.chars().take(200).collect();
        let missing = || ApiError(format!("there is no picture `{short}` in the folder of the scene"));
        let file = self.file_of_scene(name).ok_or_else(missing)?;
        if file.metadata().map_or(u64::MAX, |known| known.len()) > MAX_FILE {
            return Err(ApiError(format!("`{short}` has more than {} MiB", MAX_FILE >> 20)));
        }
        std::fs::read(&file).map_err(|why| ApiError(format!("`{short}` cannot be read: {why}")))
    }

    /// Makes a texture of a picture file, or black of a size if there is no name, and a flat shape `[m]` that has it.
    /// Returns the shape, the number of the texture and its columns and rows; none if the file is not there, which is
    /// said.
    ///
    /// # Errors
    ///
    /// There are too many textures or objects, a length is not positive, or the file is no picture.
    pub(crate) fn create_texture(
        &mut self,
        name: &str,
        [width, height]: [f64; 2],
        size: [usize; 2],
    ) -> Result<Option<(Handle, i64, [usize; 2])>, ApiError> {
        let texture = if name.is_empty() {
            Texture::black(size)?
        } else {
            match self.picture_file(name) {
                Ok(file) => Texture::of_file(name, &file)?,
                Err(ApiError(why)) => {
                    self.log(300, &format!("no texture is made: {why}"));
                    return Ok(None);
                }
            }
        };
        let (what, surface, place) = primitive_of(1, [width, height, 0.0])?;
        let size = texture.size();
        let number = self.registry.textures.add(texture)?;
        let shape = self.create_shape(what, vec![(surface, place)])?;
        self.registry.textures.put_on(shape, number)?;
        Ok(Some((shape, number, size)))
    }

    /// Gives a shape or body a texture, −1 takes it away.
    ///
    /// # Errors
    ///
    /// There is no such texture, or the object is no shape or body.
    pub(crate) fn set_texture(&mut self, handle: Handle, number: i64) -> Result<(), ApiError> {
        let entry = self.registry.entry(handle)?;
        if !matches!(entry.kind, Kind::Shape | Kind::Body(_)) {
            return Err(ApiError(format!("`{}` is no shape", entry.path)));
        }
        let own = entry.handle;
        self.registry.textures.put_on(own, number)
    }

    /// File of the scene's folder by a name or path. Of a whole path of another computer its ends are looked for.
    pub(super) fn file_of_scene(&self, name: &str) -> Option<PathBuf> {
        let text = name.replace('\\', "/");
        let folder = Path::new(&self.registry.scene_path).parent().unwrap_or(Path::new("."));
        let root = folder.canonicalize().ok()?;
        let ends = text.match_indices('/').map(|(k, _)| &text[k + 1..]);
        let below = Path::new(&text).strip_prefix(&root).or_else(|_| Path::new(&text).strip_prefix(folder)).ok();
        let candidates = below.and_then(Path::to_str).into_iter().chain([&*text]).chain(ends);
        let file = |candidate: &str| {
            let whole = root.join(candidate.trim_start_matches('/')).canonicalize().ok()?;
            (whole.is_file() && whole.starts_with(&root)).then_some(whole)
        };
        candidates.filter(|candidate| !candidate.contains('\0')).find_map(file)
    }
}

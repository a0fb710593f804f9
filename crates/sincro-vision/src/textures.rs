//! Textures: pictures that shapes can be given, by their numbers. They are kept and told again.

use std::collections::BTreeMap;

use sincro_values::{ApiError, Handle};

use crate::picture_files::{self, MAX_PIXELS};

/// Textures that may exist at once, and bytes of all of them.
const MAX_TEXTURES: (usize, usize) = (1_000, 64 << 20);
/// Number of the first texture.
const FIRST: i64 = 1;

/// Picture that shapes can be given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    name: String,
    size: [usize; 2],
    /// Red, green, blue, row by row from the top; none of a file whose pixels are not read.
    rgb: Option<Vec<u8>>,
}

/// Rectangle of a texture: first column and row, counted from 0, and numbers of columns and rows.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    at: [usize; 2],
    size: [usize; 2],
}

impl Texture {
    /// Black texture of `size` columns and rows.
    ///
    /// # Errors
    ///
    /// It would have no pixels, or too many.
    pub fn black([columns, rows]: [usize; 2]) -> Result<Self, ApiError> {
        if columns == 0 || rows == 0 || columns.checked_mul(rows).is_none_or(|n| n > MAX_PIXELS) {
            return Err(ApiError(format!(
                "a texture of {columns} × {rows} pixels: expected one at least, {MAX_PIXELS} at most"
            )));
        }
        Ok(Self { name: String::new(), size: [columns, rows], rgb: Some(vec![0; 3 * columns * rows]) })
    }

    /// Texture of a picture file of a name. Pixels of a JPEG file are not read.
    ///
    /// # Errors
    ///
    /// The file is no picture.
    pub fn of_file(name: &str, file: &[u8]) -> Result<Self, ApiError> {
        let size = picture_files::size_of(file);
        let size = size.ok_or_else(|| ApiError::new("the file is no picture: PNG, BMP and JPEG are known"))?;
        let rgb = picture_files::decode(file).ok().map(|picture| picture.rgb());
        let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
        Ok(Self { name: last.chars().take(100).collect(), size, rgb })
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Rectangle of the first column and row and the numbers of columns and rows, the whole of the texture for numbers
    /// of 0.
    ///
    /// # Errors
    ///
    /// A number is negative, or the rectangle goes beyond the texture.
    pub fn rectangle(&self, [x, y, columns, rows]: [i64; 4]) -> Result<Rectangle, ApiError> {
        let number = |n: i64| usize::try_from(n).map_err(|_| ApiError(format!("{n} is no number of pixels")));
        let (at, size) = match [number(columns)?, number(rows)?] {
            [0, 0] => ([0, 0], self.size),
            size => ([number(x)?, number(y)?], size),
        };
        if (0..2).any(|k| size[k] == 0 || at[k].checked_add(size[k]).is_none_or(|end| end > self.size[k])) {
            let [columns, rows] = self.size;
            return Err(ApiError(format!("the part goes beyond the texture of {columns} × {rows} pixels")));
        }
        Ok(Rectangle { at, size })
    }

    /// Red, green and blue of the pixels of a rectangle, row by row from the top.
    ///
    /// # Errors
    ///
    /// The pixels of its file are not read.
    pub fn read(&self, Rectangle { at, size: [columns, rows] }: Rectangle) -> Result<Vec<u8>, ApiError> {
        let missing = || ApiError(format!("the pixels of `{}` are not read: give it as PNG", self.name));
        let rgb = self.rgb.as_ref().ok_or_else(missing)?;
        let row = |j: usize| &rgb[3 * (at[0] + (at[1] + j) * self.size[0])..][..3 * columns];
        Ok((0..rows).flat_map(row).copied().collect())
    }

    /// Sets red, green and blue of the pixels of a rectangle, row by row from the top.
    ///
    /// # Errors
    ///
    /// There are more or fewer bytes than the rectangle has.
    pub fn write(&mut self, rectangle: Rectangle, bytes: &[u8]) -> Result<(), ApiError> {
        let Rectangle { at, size: [columns, rows] } = rectangle;
        if bytes.len() != 3 * columns * rows {
            return Err(ApiError(format!("{} bytes, expected {columns}·{rows}·3", bytes.len())));
        }
        let [width, height] = self.size;
        let rgb = self.rgb.get_or_insert_with(|| vec![0; 3 * width * height]);
        for (j, row) in bytes.chunks_exact(3 * columns).enumerate() {
            rgb[3 * (at[0] + (at[1] + j) * width)..][..3 * columns].copy_from_slice(row);
        }
        Ok(())
    }
}

/// Textures by their numbers, and those of shapes.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    list: Vec<Texture>,
    on: BTreeMap<Handle, usize>,
}

impl Textures {
    /// Adds a texture and returns its number.
    ///
    /// # Errors
    ///
    /// There are too many, or they are too large together.
    pub fn add(&mut self, texture: Texture) -> Result<i64, ApiError> {
        let bytes = |texture: &Texture| texture.rgb.as_ref().map_or(0, Vec::len);
        let total: usize = self.list.iter().map(bytes).sum();
        let (max_n, max_bytes) = MAX_TEXTURES;
        if self.list.len() >= max_n || total + bytes(&texture) > max_bytes {
            let mib = max_bytes >> 20;
            return Err(ApiError(format!("there may be {max_n} textures of {mib} MiB together, no more")));
        }
        self.list.push(texture);
        Ok(self.list.len() as i64 - 1 + FIRST)
    }

    fn index(&self, number: i64) -> Result<usize, ApiError> {
        let k = number.checked_sub(FIRST).and_then(|k| usize::try_from(k).ok()).filter(|k| *k < self.list.len());
        k.ok_or_else(|| ApiError(format!("there is no texture {number}: sim.createTexture makes them")))
    }

    /// Texture of a number.
    ///
    /// # Errors
    ///
    /// There is none.
    pub fn get(&mut self, number: i64) -> Result<&mut Texture, ApiError> {
        let k = self.index(number)?;
        Ok(&mut self.list[k])
    }

    /// Gives an object a texture; −1 takes it away.
    ///
    /// # Errors
    ///
    /// There is no such texture.
    pub fn put_on(&mut self, own: Handle, number: i64) -> Result<(), ApiError> {
        if number == -1 {
            self.forget(own);
            return Ok(());
        }
        let k = self.index(number)?;
        self.on.insert(own, k);
        Ok(())
    }

    /// Number of the texture of an object; none without one.
    #[must_use]
    pub fn on(&self, own: Handle) -> Option<i64> {
        self.on.get(&own).map(|k| *k as i64 + FIRST)
    }

    /// Number of the texture of a file of a name; none if there is none.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<i64> {
        let k = self.list.iter().position(|texture| !name.is_empty() && texture.name == name)?;
        Some(k as i64 + FIRST)
    }

    /// Forgets an object that was removed.
    pub fn forget(&mut self, own: Handle) {
        self.on.remove(&own);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_is_written_and_read_within_the_texture() {
        let mut texture = Texture::black([3, 2]).unwrap();
        let right = texture.rectangle([1, 0, 2, 2]).unwrap();
        texture.write(right, &(1..=12).collect::<Vec<u8>>()).unwrap();
        assert!(texture.write(right, &[0]).is_err());
        let whole = texture.rectangle([0; 4]).unwrap();
        assert_eq!(texture.read(whole).unwrap(), [0, 0, 0, 1, 2, 3, 4, 5, 6, 0, 0, 0, 7, 8, 9, 10, 11, 12]);
        let corner = texture.rectangle([2, 1, 1, 1]).unwrap();
        assert_eq!(texture.read(corner).unwrap(), [10, 11, 12]);
        for beyond in [[2, 0, 2, 1], [0, 0, 1, 0], [-1, 0, 1, 1], [0, i64::MAX, 1, 1]] {
            assert!(texture.rectangle(beyond).is_err(), "{beyond:?}");
        }
        assert!(Texture::black([0, 1]).is_err() && Texture::black([usize::MAX, 2]).is_err());
    }

    #[test]
    fn an_object_has_the_texture_that_it_was_given_last() {
        let mut textures = Textures::default();
        let [one, other] = [1, 2].map(|n| textures.add(Texture::black([n, n]).unwrap()).unwrap());
        let own = Handle(7);
        textures.put_on(own, one).unwrap();
        textures.put_on(own, other).unwrap();
        assert_eq!((textures.on(own), textures.on(Handle(8))), (Some(other), None));
        assert!(textures.put_on(own, 3).is_err() && textures.get(i64::MIN).is_err());
        textures.put_on(own, -1).unwrap();
        assert_eq!(textures.on(own), None);
    }
}

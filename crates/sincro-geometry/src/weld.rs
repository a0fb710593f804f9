//! Triangle meshes from lists of triangles: corners with the same coordinates are one.

/// Triangle mesh: corners and the triangles between them, each corner once, as a mesh file has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Coordinates x, y, z of the corners in the frame of the file `[m]`.
    pub corners: Vec<[f64; 3]>,
    /// Indices of the three corners of each triangle, in the order of the file (by convention counterclockwise seen
    /// from outside).
    pub triangles: Vec<[u32; 3]>,
}

/// Collector of triangles whose corners are given again and again; the same bits are the same corner.
///
/// Corners are found in a hash table with open addressing. Its seed differs from run to run, so that no file can be
/// made of corners that all collide; the order of the corners does not depend on it.
#[derive(Clone, Debug)]
pub struct Weld {
    /// Triangles and corners so far.
    pub mesh: Triangles,
    /// Index of a corner, or [`FREE`]; a power of two of them, of which half are free at least.
    slots: Vec<u32>,
    seed: u64,
}

/// Slot of the hash table without a corner.
const FREE: u32 = u32::MAX;

impl Default for Weld {
    fn default() -> Self {
        let seed = std::hash::BuildHasher::build_hasher(&std::hash::RandomState::new());
        Self { mesh: Triangles::default(), slots: vec![FREE; 64], seed: std::hash::Hasher::finish(&seed) }
    }
}

impl Weld {
    /// Returns the index of the corner at `p` `[m]`, which is appended if it is new.
    pub fn corner(&mut self, p: [f64; 3]) -> u32 {
        if 2 * self.mesh.corners.len() >= self.slots.len() {
            self.grow();
        }
        let key = Self::key(p);
        let slot = self.slot(key);
        if self.slots[slot] == FREE {
            self.slots[slot] = self.mesh.corners.len() as u32;
            self.mesh.corners.push(p);
        }
        self.slots[slot]
    }

    /// Bits of a corner; zero has two signs.
    fn key([x, y, z]: [f64; 3]) -> [u64; 3] {
        [(x + 0.0).to_bits(), (y + 0.0).to_bits(), (z + 0.0).to_bits()]
    }

    /// Slot that holds the corner with these bits, or the free one where it belongs.
    fn slot(&self, [x, y, z]: [u64; 3]) -> usize {
        let fold = |hash: u64, word: u64| {
            let product = u128::from(hash ^ word) * 0x9e37_79b9_7f4a_7c15;
            product as u64 ^ (product >> 64) as u64 ^ self.seed
        };
        let (mask, mut slot) = (self.slots.len() - 1, fold(fold(fold(self.seed, x), y), z) as usize);
        loop {
            slot &= mask;
            let known = self.slots[slot];
            if known == FREE {
                return slot;
            }
            let [a, b, c] = Self::key(self.mesh.corners[known as usize]);
            // one branch: corners differ in any of the three
            if (a ^ x) | (b ^ y) | (c ^ z) == 0 {
                return slot;
            }
            slot += 1;
        }
    }

    fn grow(&mut self) {
        self.slots = vec![FREE; 2 * self.slots.len()];
        for k in 0..self.mesh.corners.len() {
            let slot = self.slot(Self::key(self.mesh.corners[k]));
            self.slots[slot] = k as u32;
        }
    }
}

//! Writes small NanoVDB files, for tests: dense boxes of voxels in the layout of format 32.
#![allow(dead_code)]

use std::collections::BTreeMap;

type Voxel = [i32; 3];

/// A grid to write.
pub struct Spec<'f> {
    pub name: &'f str,
    /// Number of the type: 1 float, 2 double, 13 to 16 quantised.
    pub kind: u32,
    pub class: u32,
    pub first: Voxel,
    pub last: Voxel,
    pub voxel_size: f64,
    pub offset: [f64; 3],
    pub value: &'f dyn Fn(Voxel) -> f32,
}

impl Spec<'_> {
    /// Bits of the codes of a quantised grid; what this writer gives leaf `i` of a grid of variable width.
    fn bits(&self, leaf: usize) -> u32 {
        match self.kind {
            13 => 4,
            14 => 8,
            15 => 16,
            _ => [1, 2, 4, 8, 16][leaf % 5],
        }
    }
}

struct Out(Vec<u8>);

impl Out {
    fn put(&mut self, at: usize, bytes: &[u8]) {
        self.0[at..at + bytes.len()].copy_from_slice(bytes);
    }

    fn ints(&mut self, at: usize, v: Voxel) {
        for k in 0..3 {
            self.put(at + 4 * k, &v[k].to_le_bytes());
        }
    }

    fn value(&mut self, at: usize, kind: u32, v: f32) {
        if kind == 2 { self.put(at, &f64::from(v).to_le_bytes()) } else { self.put(at, &v.to_le_bytes()) }
    }

    fn child(&mut self, mask: usize, table: usize, i: usize, offset: i64) {
        self.0[mask + i / 8] |= 1 << (i % 8);
        self.put(table + 8 * i, &offset.to_le_bytes());
    }
}

/// The bytes of a grid.
pub fn grid(spec: &Spec<'_>) -> Vec<u8> {
    let wide = spec.kind == 2;
    let range = |k: usize, shift: i32| (spec.first[k] >> shift)..=(spec.last[k] >> shift);
    let all = |shift: i32| -> Vec<Voxel> {
        let cells = |x| range(1, shift).flat_map(move |y| range(2, shift).map(move |z| [x, y, z]));
        range(0, shift).flat_map(cells).map(|c| c.map(|v| v << shift)).collect()
    };
    let (uppers, lowers, leaves) = (all(12), all(7), all(3));
    let leaf_size = |i: usize| match spec.kind {
        1 => 2144,
        2 => 128 + 4096,
        _ => 96 + 64 * spec.bits(i) as usize,
    };
    let root = 672 + 64;
    let tiles = root + if wide { 96 } else { 64 };
    let upper = tiles + 32 * uppers.len();
    let lower = upper + 270_400 * uppers.len();
    let leaf = lower + 33_856 * lowers.len();
    let leaf_at: Vec<usize> =
        (0..leaves.len()).scan(leaf, |at, i| Some(std::mem::replace(at, *at + leaf_size(i)))).collect();
    let size = leaf + (0..leaves.len()).map(leaf_size).sum::<usize>();
    let mut out = Out(vec![0; size]);
    describe(&mut out, spec, root, size);

    // root
    out.ints(root, spec.first);
    out.ints(root + 12, spec.last);
    out.put(root + 24, &(uppers.len() as u32).to_le_bytes());
    for (i, origin) in uppers.iter().enumerate() {
        let key = origin.iter().fold(0u64, |key, v| key << 21 | u64::from(*v as u32 >> 12));
        out.put(tiles + 32 * i, &key.to_le_bytes());
        let offset = (upper + 270_400 * i - root) as i64;
        out.put(tiles + 32 * i + 8, &offset.to_le_bytes());
    }
    let places = |origins: &[Voxel], first: usize, size: usize| -> BTreeMap<Voxel, usize> {
        origins.iter().enumerate().map(|(i, o)| (*o, first + size * i)).collect()
    };
    let (upper_at, lower_at) = (places(&uppers, upper, 270_400), places(&lowers, lower, 33_856));
    for origin in &lowers {
        let parent = upper_at[&origin.map(|v| v >> 12 << 12)];
        let i = origin.iter().fold(0, |i, v| i << 5 | (v >> 7 & 31) as usize);
        let offset = lower_at[origin] as i64 - parent as i64;
        out.child(parent + 32 + 4096, parent + 8256, i, offset);
    }
    for (n, origin) in leaves.iter().enumerate() {
        let parent = lower_at[&origin.map(|v| v >> 7 << 7)];
        let i = origin.iter().fold(0, |i, v| i << 4 | (v >> 3 & 15) as usize);
        out.child(parent + 32 + 512, parent + 1088, i, leaf_at[n] as i64 - parent as i64);
        write_leaf(&mut out, spec, leaf_at[n], n, *origin);
    }
    out.0
}

fn describe(out: &mut Out, spec: &Spec<'_>, root: usize, size: usize) {
    out.put(0, b"NanoVDB0");
    out.put(16, &(32u32 << 21 | 6 << 10).to_le_bytes());
    out.put(28, &1u32.to_le_bytes());
    out.put(32, &(size as u64).to_le_bytes());
    out.put(40, spec.name.as_bytes());
    for k in 0..3 {
        out.put(296 + 88 + 32 * k, &spec.voxel_size.to_le_bytes());
        out.put(296 + 88 + 144 + 8 * k, &spec.offset[k].to_le_bytes());
    }
    out.put(632, &spec.class.to_le_bytes());
    out.put(636, &spec.kind.to_le_bytes());
    out.put(672 + 24, &((root - 672) as i64).to_le_bytes());
}

/// What a leaf of this kind keeps of the values.
pub fn stored(spec: &Spec<'_>, leaf: usize, values: &[f32]) -> Vec<f32> {
    if spec.kind <= 2 {
        return values.to_vec();
    }
    let (low, step) = quantum(spec.bits(leaf), values);
    codes(low, step, values).into_iter().map(|c| f32::from(c) * step + low).collect()
}

fn quantum(bits: u32, values: &[f32]) -> (f32, f32) {
    let low = values.iter().copied().fold(f32::INFINITY, f32::min);
    let high = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    (low, (high - low) / ((1u32 << bits) - 1) as f32)
}

fn codes(low: f32, step: f32, values: &[f32]) -> Vec<u16> {
    values.iter().map(|v| if step > 0.0 { ((v - low) / step + 0.5) as u16 } else { 0 }).collect()
}

/// The 512 values of the leaf at `origin`, zero outside the box.
pub fn values(spec: &Spec<'_>, origin: Voxel) -> Vec<f32> {
    (0..512)
        .map(|i| [origin[0] + (i >> 6), origin[1] + (i >> 3 & 7), origin[2] + (i & 7)])
        .map(|v| {
            let inside = (0..3).all(|k| v[k] >= spec.first[k] && v[k] <= spec.last[k]);
            if inside { (spec.value)(v) } else { 0.0 }
        })
        .collect()
}

fn write_leaf(out: &mut Out, spec: &Spec<'_>, at: usize, n: usize, origin: Voxel) {
    out.ints(at, origin);
    let values = values(spec, origin);
    if spec.kind <= 2 {
        let (first, each) = if spec.kind == 2 { (128, 8) } else { (96, 4) };
        for (i, v) in values.iter().enumerate() {
            out.value(at + first + each * i, spec.kind, *v);
        }
        return;
    }
    let bits = spec.bits(n);
    out.0[at + 15] = (bits.trailing_zeros() as u8) << 5;
    let (low, step) = quantum(bits, &values);
    out.put(at + 80, &low.to_le_bytes());
    out.put(at + 84, &step.to_le_bytes());
    for (i, code) in codes(low, step, &values).into_iter().enumerate() {
        let bit = i * bits as usize;
        for (k, byte) in (code << (bit % 8)).to_le_bytes().into_iter().enumerate() {
            if bits == 16 || k == 0 {
                out.0[at + 96 + bit / 8 + k] |= byte;
            }
        }
    }
}

/// A file of grids: codec 0 none, 1 zip, 2 blosc; `pack` gives what is stored of a grid.
pub fn file(codec: u16, specs: &[Spec<'_>], pack: impl Fn(Vec<u8>) -> Vec<u8>) -> Vec<u8> {
    let mut out = b"NanoVDB2".to_vec();
    out.extend((32u32 << 21 | 6 << 10).to_le_bytes());
    out.extend((specs.len() as u16).to_le_bytes());
    out.extend(codec.to_le_bytes());
    let mut bodies = Vec::new();
    for spec in specs {
        let plain = grid(spec);
        let size = plain.len() as u64;
        let packed = pack(plain);
        let mut meta = vec![0; 176];
        meta[0..8].copy_from_slice(&size.to_le_bytes());
        meta[8..16].copy_from_slice(&(packed.len() as u64).to_le_bytes());
        meta[136..140].copy_from_slice(&(spec.name.len() as u32 + 1).to_le_bytes());
        meta[168..170].copy_from_slice(&codec.to_le_bytes());
        out.extend(meta);
        out.extend(spec.name.as_bytes());
        out.push(0);
        bodies.extend(packed);
    }
    out.extend(bodies);
    out
}

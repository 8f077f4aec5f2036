//! Triangles, and their export as the bytes of an STL file.

/// A closed triangulated surface in mm, counter-clockwise seen from outside.
#[derive(Default)]
pub(crate) struct Mesh {
    /// Corners, mm.
    pub(crate) vertices: Vec<[f64; 3]>,
    /// Three indices into `vertices` each.
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds a corner and returns its index.
    pub(crate) fn vertex(&mut self, point: [f64; 3]) -> u32 {
        self.vertices.push(point);
        self.vertices.len() as u32 - 1
    }

    /// Adds two triangles, split along the diagonal a-c.
    pub(crate) fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangles.push([a, b, c]);
        self.triangles.push([a, c, d]);
    }

    /// A box with two triangles a side.
    pub(crate) fn cuboid(min: [f64; 3], max: [f64; 3]) -> Self {
        let mut mesh = Self::default();
        for corner in 0..8 {
            mesh.vertex(std::array::from_fn(|k| {
                if corner >> k & 1 == 0 { min[k] } else { max[k] }
            }));
        }
        for side in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            mesh.quad(side);
        }
        mesh
    }

    /// Adds the surface of `other`.
    pub(crate) fn append(&mut self, other: &Self) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(&other.vertices);
        self.triangles
            .extend(other.triangles.iter().map(|t| t.map(|v| v + first)));
    }

    /// Reverses every normal, which turns a solid into a cavity.
    pub(crate) fn turn_inside_out(&mut self) {
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
    }

    /// The bytes of a binary STL file.
    pub(crate) fn stl_bytes(&self, name: &str) -> Vec<u8> {
        let mut bytes = format!("Crumble {name}, mm").into_bytes();
        bytes.resize(80, b' ');
        bytes.extend((self.triangles.len() as u32).to_le_bytes());
        for triangle in &self.triangles {
            let corners = triangle.map(|v| self.vertices[v as usize].map(rounded_mm));
            let [a, b, c] = corners;
            let normal = unit(cross(sub(b, a), sub(c, a)));
            for number in std::iter::once(normal).chain(corners).flatten() {
                bytes.extend((number as f32).to_le_bytes());
            }
            bytes.extend([0, 0]);
        }
        bytes
    }
}

/// Rounded to 0.1 um, since sine and cosine differ in their last bit between platforms; never -0.
fn rounded_mm(length: f64) -> f64 {
    (length * 1e4).round() / 1e4 + 0.0
}

/// a - b.
pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// Scalar product.
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The vector of length 1 in the direction of `a`.
pub(crate) fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

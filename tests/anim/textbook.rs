//! A second implementation of the formulas, in f64, that uses nothing but the intermediate values of an explanation.

pub(crate) type Matrix = [[f64; 4]; 4];

/// Column-major, as in glam.
pub(crate) fn matrix(matrix: glam::Mat4) -> Matrix {
    matrix.to_cols_array_2d().map(|column| column.map(f64::from))
}

pub(crate) fn product(a: Matrix, b: Matrix) -> Matrix {
    let mut out = [[0.0; 4]; 4];
    for column in 0..4 {
        for row in 0..4 {
            out[column][row] = (0..4).map(|k| a[k][row] * b[column][k]).sum();
        }
    }
    out
}

pub(crate) fn point(matrix: Matrix, point: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|row| (0..3).map(|k| matrix[k][row] * point[k]).sum::<f64>() + matrix[3][row])
}

/// Returns `T · R · S`, each entry from the definition of the quaternion.
pub(crate) fn to_parent(t: [f64; 3], [x, y, z, w]: [f64; 4], s: [f64; 3]) -> Matrix {
    let turn = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
        [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let column = |k: usize| [turn[k][0] * s[k], turn[k][1] * s[k], turn[k][2] * s[k], 0.0];
    [column(0), column(1), column(2), [t[0], t[1], t[2], 1.0]]
}

/// Interpolates between two values, component by component.
pub(crate) fn lerp<const N: usize>(a: [f64; N], b: [f64; N], mix: f64) -> [f64; N] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * mix)
}

/// Interpolates on the shorter arc between two unit quaternions.
pub(crate) fn slerp(a: [f64; 4], b: [f64; 4], mix: f64) -> [f64; 4] {
    let dot: f64 = (0..4).map(|k| a[k] * b[k]).sum();
    let b = if dot < 0.0 { b.map(|n| -n) } else { b };
    let angle = dot.abs().min(1.0).acos();
    let weights = if angle < 1e-9 {
        [1.0 - mix, mix]
    } else {
        [((1.0 - mix) * angle).sin() / angle.sin(), (mix * angle).sin() / angle.sin()]
    };
    unit(std::array::from_fn(|k| weights[0] * a[k] + weights[1] * b[k]))
}

/// Evaluates the Hermite polynomials.
pub(crate) fn hermite<const N: usize>(ends: [[f64; N]; 4], span: f64, m: f64) -> [f64; N] {
    let [a, leave, arrive, b] = ends;
    let h = |k: usize| {
        (1.0 + 2.0 * m) * (1.0 - m).powi(2) * a[k]
            + m * (1.0 - m).powi(2) * span * leave[k]
            + m * m * (3.0 - 2.0 * m) * b[k]
            + m * m * (m - 1.0) * span * arrive[k]
    };
    std::array::from_fn(h)
}

pub(crate) fn unit(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|n| n * n).sum::<f64>().sqrt();
    q.map(|n| n / length)
}

//! What Nowrouzezahrai, Simari and Fiume (2012), "Sparse Zonal Harmonic Factorization for Efficient SH Rotation",
//! print: data to compare with, and what is wrong in it (docs/MATH.md#errata-of-the-papers). And Table 1 of Gautron,
//! Křivánek, Pattanaik and Bouatouch (2004), "A Novel Hemispherical Basis for Accurate and Efficient Rendering".

/// Table 1 of Gautron et al. 2004: an order, and frames a second in HSH and in SH.
pub const FRAMES: [(usize, f64, f64); 5] =
    [(2, 220.0, 223.0), (3, 138.0, 160.0), (5, 26.2, 29.0), (8, 3.1, 3.28), (10, 1.6, 1.73)];

/// Table I: the percentage of zeros in Â of the bands from 2 on.
pub const SPARSITY: [usize; 17] = [64, 67, 62, 53, 49, 46, 42, 39, 38, 38, 37, 37, 36, 36, 36, 35, 35];

/// Table I: the number of lobes of each function, m = −l to l, of the bands from 2 to 6.
pub const LOBES: [&[usize]; 5] = [
    &[2, 2, 1, 2, 2],
    &[2, 2, 2, 1, 3, 3, 3],
    &[3, 4, 4, 5, 1, 5, 2, 4, 3],
    &[3, 7, 5, 10, 5, 1, 7, 5, 7, 3, 4],
    &[9, 4, 8, 4, 9, 7, 1, 10, 6, 10, 5, 8, 5],
];

/// A column of Table II: multiplications at an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// The order.
    pub order: usize,
    /// A rotation about z.
    pub z: usize,
    /// A rotation about z by recurrences.
    pub z_optimised: usize,
    /// A rotation about x by 90 degrees.
    pub x: usize,
    /// Three z and two x.
    pub zxzxz: usize,
    /// The basis at one direction.
    pub basis: usize,
    /// The product with [Y^R]ᵀ.
    pub values: usize,
    /// The product with Â.
    pub sparse: usize,
    /// The standard rotation on a CPU.
    pub standard: usize,
    /// The standard rotation on a GPU, the basis read from textures.
    pub tabulated: usize,
}

const fn column(row: [usize; 10]) -> Column {
    let [order, z, z_optimised, x, zxzxz, basis, values, sparse, standard, tabulated] = row;
    Column { order, z, z_optimised, x, zxzxz, basis, values, sparse, standard, tabulated }
}

/// Table II. The scan's 127 and "20.4" for Â at the orders 6 and 8 are 137 and 384, as the totals below them say.
pub const TABLE_2: [Column; 17] = [
    column([3, 34, 16, 5, 112, 14, 25, 9, 90, 34]),
    column([4, 52, 32, 18, 192, 28, 74, 33, 275, 107]),
    column([5, 74, 52, 39, 300, 47, 155, 75, 606, 230]),
    column([6, 100, 76, 71, 442, 71, 276, 137, 1123, 413]),
    column([7, 130, 104, 115, 620, 100, 445, 246, 1891, 691]),
    column([8, 164, 136, 171, 834, 134, 670, 384, 2930, 1054]),
    column([9, 202, 172, 243, 1092, 173, 959, 570, 4297, 1529]),
    column([10, 244, 212, 334, 1400, 217, 1320, 820, 6046, 2140]),
    column([11, 290, 256, 445, 1760, 266, 1761, 1118, 8199, 2879]),
    column([12, 340, 304, 576, 2172, 320, 2290, 1453, 10783, 3743]),
    column([13, 394, 356, 733, 2648, 379, 2915, 1849, 13860, 4764]),
    column([14, 452, 412, 916, 3188, 443, 3644, 2333, 17495, 5977]),
    column([15, 514, 472, 1757, 5056, 512, 4485, 2851, 21672, 7336]),
    column([16, 580, 536, 2718, 7176, 586, 5446, 3524, 26550, 8970]),
    column([17, 650, 604, 3807, 9564, 665, 6535, 4199, 32014, 10734]),
    column([18, 724, 676, 5032, 12236, 749, 7760, 5030, 38256, 12790]),
    column([19, 802, 752, 6401, 15208, 838, 9129, 6014, 45311, 15143]),
];

/// What a column should say, from the formulas that the print agrees with: `nonzeros` are those of the x rotation in the
/// bands from 2 on. The standard rotation takes the 2N − 1 directions that the text names; the print has 2N − 2.
pub fn recomputed(printed: &Column, nonzeros: usize) -> Column {
    let n = printed.order;
    let (z, basis, values) = (2 * n * n + 4 * n + 4, (5 * n * n - 7 * n + 4) / 2, n * (4 * n * n - 1) / 3 - 10);
    Column {
        z,
        z_optimised: 2 * n * (n - 1) + 4 * (n - 2),
        x: nonzeros,
        zxzxz: 3 * z + 2 * nonzeros,
        basis,
        values,
        standard: (2 * n - 1) * basis + values + printed.sparse,
        tabulated: values + printed.sparse,
        ..*printed
    }
}

/// What is wrong in print and bears on the tables.
pub const ERRATA: [&str; 5] = [
    "Table II, standard rotation on a CPU: counted with 2N − 2 evaluations of the basis; the text says 2N − 1 directions. \
     The recomputed column has 2N − 1.",
    "Table II, x-rotation: the print is the count of non-zeros in the bands from 2 on, less 0 to 2 entries that are one; \
     from N = 15 on a dense matrix is counted for every band l ≥ 14, where the sparse count is half.",
    "Table II against Figure 3: 384 of 670 entries at N = 8 are a sparsity of 43 %; the figure's caption says 45 %.",
    "Equations 7 to 9: a lobe turned to ω is n* times the product of basis values, so that the weights of lobes are \
     Âᵀ f / n*; equations 10 and 11, and what is generated here, are right as they stand.",
    "Section 4: ν is √3 / (2 √π), not √3 / (2 √2).",
];

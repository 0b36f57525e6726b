//! Complex coefficients on the graph: c_{l,m} + i c_{l,−m}, with an imaginary part of zero where m = 0. What is multiplied
//! by zero vanishes, so that one formula serves real and complex modes.

use crate::ir::graph::{Graph, Id};
use crate::math::gaunt::Mode;
use crate::math::index::index;

/// A real and an imaginary part.
pub type Wave = [Id; 2];

/// Every mode of some order.
#[derive(Clone, Debug)]
pub struct Waves {
    all: Vec<Wave>,
    zero: Id,
}

fn place((l, m): Mode) -> usize {
    l * (l + 1) / 2 + m
}

impl Waves {
    /// Nothing in any mode of an order.
    pub fn zeros(order: usize, zero: Id) -> Self {
        Self { all: vec![[zero; 2]; order * (order + 1) / 2], zero }
    }

    /// The modes of coefficients.
    pub fn of(coefficients: &[Id], zero: Id) -> Self {
        let order = coefficients.len().isqrt();
        let mut waves = Self::zeros(order, zero);
        for l in 0..order {
            for m in 0..=l {
                let imaginary = if m == 0 { zero } else { coefficients[index(l, -(m as isize))] };
                waves.set((l, m), [coefficients[index(l, m as isize)], imaginary]);
            }
        }
        waves
    }

    /// Returns a mode; zero where the order ends below.
    pub fn at(&self, mode: Mode) -> Wave {
        self.all.get(place(mode)).copied().unwrap_or([self.zero; 2])
    }

    /// Changes a mode; nothing where the order ends below.
    pub fn set(&mut self, mode: Mode, wave: Wave) {
        if let Some(own) = self.all.get_mut(place(mode)) {
            *own = wave;
        }
    }

    /// Returns the coefficients of an order by index.
    pub fn coefficients(&self, order: usize) -> Vec<Id> {
        let of = |l: usize, m: isize| self.at((l, m.unsigned_abs()))[usize::from(m < 0)];
        crate::math::index::coefficients(order).map(|(l, m)| of(l, m)).collect()
    }
}

/// sum + u v.
pub fn add(g: &mut Graph, sum: Wave, u: Wave, v: Wave) -> Wave {
    let re = g.mul_add(u[0], v[0], sum[0]);
    let minus = g.mul(u[1], v[1]);
    let im = g.mul_add(u[0], v[1], sum[1]);
    [g.sub(re, minus), g.mul_add(u[1], v[0], im)]
}

/// sum + u v̄.
pub fn add_turned(g: &mut Graph, sum: Wave, u: Wave, v: Wave) -> Wave {
    let minus = g.neg(v[1]);
    add(g, sum, u, [v[0], minus])
}

/// sum + Re u v̄, the imaginary part left as it is.
pub fn add_real(g: &mut Graph, sum: Wave, u: Wave, v: Wave) -> Wave {
    let re = g.mul_add(u[0], v[0], sum[0]);
    [g.mul_add(u[1], v[1], re), sum[1]]
}

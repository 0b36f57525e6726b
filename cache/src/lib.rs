//! Radiance caching (Křivánek et al. 2005, section 4.2; Gautron et al. 2004, section 6): the light that arrives at a glossy
//! surface is sampled at few points, stored in spherical or hemispherical harmonics with its derivatives, and turned and
//! averaged for the points between. Every basis and every rotation is a generated kernel.
//!
//! ```text
//! Scene ─▶ light (a ray, what it brings) ─▶ Record (harmonics, derivatives) ─▶ Cache ─┐
//! camera ─▶ View (what a pixel sees) ─────────────────────────────────────────────────┼─▶ frames ─▶ study ─▶ page
//! Basis (kernels) ─▶ Method (a rotation below the limit, one above) ──────────────────┘
//! ```

pub mod basis;
pub mod cache;
pub mod dual;
pub mod gloss;
pub mod gradient;
pub mod light;
pub mod methods;
pub mod page;
pub mod picture;
pub mod place;
pub mod record;
pub mod scene;
pub mod study;
pub mod table;
pub mod view;

//! A ball with a relief as a mirror, its pixels by one sample, by Gaussians and by many samples: what antialiasing of
//! reflections on the sphere gains and costs (Soler et al. 2015, section 6.2).

pub mod ball;
pub mod light;
pub mod page;

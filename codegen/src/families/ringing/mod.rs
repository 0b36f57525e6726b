//! What keeps a signal from ringing (docs/MATH.md#ringing): the exact minimum of an order-3 function, what is done with it,
//! windows of bands, and reconstructions of four numbers that are not linear.

pub mod minimum;
pub mod probes;
pub mod window;

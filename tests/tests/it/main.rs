//! The tests of the generator, one module a subject, in one program: it is linked once, and what they share is built once.

mod accuracy;
mod bounds;
mod brdf;
mod builder;
mod catalog;
mod citations;
mod cli;
mod environment;
mod fixture;
mod goldens;
mod half;
mod laws;
mod loops;
mod methods;
mod plans;
mod proofs;
mod properties;
mod readme;
mod requirements;
mod runtime;
mod scenes;
mod search;
mod shader_evaluator;
mod shaders;
mod tables;
mod zhf_tables;

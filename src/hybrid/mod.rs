pub mod accumulation;
pub mod instant;
pub mod roots;

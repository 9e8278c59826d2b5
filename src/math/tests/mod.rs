mod accuracy;
mod flushing;
mod formulas;

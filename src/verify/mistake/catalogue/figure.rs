//! Figures on the screen.

use super::mistakes;

const DISK: &str = "return dot(d, d) - radius * radius;";
const WAVE: &str = "return p.y - height - amplitude * sin(frequency * p.x);";
const HEART: &str = "return ring * ring * ring - q.x * q.x * q.y * q.y * q.y;";

mistakes! {
    "disk-radius-not-squared": "does not square the disk's radius", [(DISK, "return dot(d, d) - radius;")];
    "disk-inside-out": "fills the outside of the disk", [(DISK, "return radius * radius - dot(d, d);")];
    "wave-upside-down": "fills the space above the wave, not below it",
        [(WAVE, "return height + amplitude * sin(frequency * p.x) - p.y;")],
        [(WAVE, "return height - p.y + amplitude * sin(frequency * p.x);")];
    "wave-mirrored": "has the wave upside down", [(WAVE, "return p.y - height + amplitude * sin(frequency * p.x);")];
    "wave-in-turns": "takes the wave's frequency for turns, not for radians",
        [(WAVE, "return p.y - height - amplitude * sin(6.28318530718 * frequency * p.x);")];
    "wave-of-cosine": "has a cosine for the wave's sine", [(WAVE, "return p.y - height - amplitude * cos(frequency * p.x);")];
    "heart-upside-down": "has the heart upside down", [(HEART, "return ring * ring * ring + q.x * q.x * q.y * q.y * q.y;")];
    "ring-not-cubed": "does not cube the ring of the heart", [(HEART, "return ring - q.x * q.x * q.y * q.y * q.y;")];
    "ring-squared": "squares the ring of the heart where it should cube it", [(HEART, "return ring * ring - q.x * q.x * q.y * q.y * q.y;")];
}

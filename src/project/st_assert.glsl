bvec4 st_failed = bvec4(false);
void st_assert(bool condition, int value) {
    if (!condition) st_failed[value >= 0 && value < 3 ? value : 3] = true;
}
void st_assert(bool condition) { st_assert(condition, 0); }
#define mainImage st_mainImage

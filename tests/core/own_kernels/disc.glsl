// Shared by kernels of a user's own, as they share theirs.
#ifndef TESTS_DISC
#define TESTS_DISC

inline float disc_area(float radius2)
{
    precise float area = 3.14159265f * radius2;
    return area;
}

#endif

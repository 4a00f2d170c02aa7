// A texel with two (key, value) pairs, for a sorting network.

inline bool is_less(uvec2 a, uvec2 b)
{
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

// The result of comparing each pair with the partner's: the smaller ones, or the larger ones.
inline uvec4 kept_of(uvec4 mine, uvec4 partner, bool smaller)
{
    bool first = is_less(uvec2(mine.x, mine.y), uvec2(partner.x, partner.y)) == smaller;
    bool second = is_less(uvec2(mine.z, mine.w), uvec2(partner.z, partner.w)) == smaller;
    return uvec4(first ? mine.x : partner.x, first ? mine.y : partner.y, second ? mine.z : partner.z, second ? mine.w : partner.w);
}

// The step of stride 1, within the texel.
inline uvec4 in_order(uvec4 t, bool rising)
{
    bool stays = is_less(uvec2(t.x, t.y), uvec2(t.z, t.w)) == rising;
    return stays ? t : uvec4(t.z, t.w, t.x, t.y);
}

// The mean height of the trees nearest to each point; near trees have a larger weight (inverse distance weighting,
// Shepard 1968).
struct Params {
    uint k; // entries per list
};
PARAMS(Params)
INPUT(0, uint, ids)         // of trees, k for each point; 0xFFFFFFFF: no further tree
INPUT(1, float, distances2) // m^2
INPUT(2, float, heights)    // of all trees, m
OUTPUT(0, float, mean)      // m; 0 where there is no tree

void kernel(uint i)
{
    float sum = 0.0f;
    float weights = 0.0f;
    for (uint entry = i * args.k; entry < (i + 1u) * args.k; ++entry) {
        uint tree = ids(entry);
        if (tree != 0xFFFFFFFFu) {
            precise float weight = 1.0f / (1.0f + distances2(entry));
            precise float new_sum = sum + weight * heights(tree);
            precise float new_weights = weights + weight;
            sum = new_sum;
            weights = new_weights;
        }
    }
    mean = weights > 0.0f ? sum / weights : 0.0f;
}

// True for a cell whose range ends past the last photon; only a faulty device produces one.
struct Params {
    uint photons;
};
PARAMS(Params)
INPUT(0, uvec2, cells) // x: first photon, y: count

bool holds(uint i)
{
    uvec2 cell = cells(i);
    return cell.x > args.photons || cell.y > args.photons - cell.x;
}

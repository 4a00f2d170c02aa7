// The standard error of the sum of two independent estimates.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, more)
STATE(0, vec4, standard_error) // rgb, W/m^2; w: of the sum of the channels

void kernel(uint i)
{
    vec4 m = more(i);
    precise vec4 squares = standard_error * standard_error + m * m;
    standard_error = vec4(sqrt(squares.x), sqrt(squares.y), sqrt(squares.z), sqrt(squares.w));
}

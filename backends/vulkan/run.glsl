// One pass: every element once.
void main()
{
    uint at = element_();
    if (group_() < launch_.z && at < launch_.x) {
        uint where = launch_.w + at;
        LOAD_ALL(where)
        kernel(launch_.y + at);
        STORE_ALL(where)
    }
}

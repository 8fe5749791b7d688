// Linked to programs that the address sanitizer watches: drivers stay loaded, so that what they leak has their name
// when the program ends, and leaks.supp can tell it from what this library leaks.

int dlclose(void* library)
{
    (void)library;
    return 0;
}

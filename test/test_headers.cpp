// Source of the library whose precompiled headers the tests share.

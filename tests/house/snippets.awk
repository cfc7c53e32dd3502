# Turns the ```cpp blocks of a page into one program: their includes first, each block in a scope of its own.
/^```cpp/ { inside = 1; body = body "{\n"; next }
/^```/ && inside { inside = 0; body = body "}\n"; next }
inside && /^#include/ { includes = includes $0 "\n"; next }
inside { body = body $0 "\n" }
END { if (body != "") printf "#include <cassert>\n%s\nint main() {\n%sreturn 0;\n}\n", includes, body }

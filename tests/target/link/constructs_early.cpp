namespace {

struct Registered {
  Registered();
  volatile int count = 0;
};
Registered::Registered() { count = 1; }

Registered registered;

}  // namespace

int main() { return registered.count; }


real	0m17.886s
user	0m17.194s
sys	0m0.618s

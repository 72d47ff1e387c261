#pragma once
#define JVERSION "6b  27-Mar-1998"
#define JCOPYRIGHT "libjpeg-turbo project and others"
#define JCOPYRIGHT_SHORT JCOPYRIGHT

#define R iResolution
#define V vec3
#define E .001
// s: sphere (xyz, radius)   returns t or 1e5
float S(V o,V d,vec4 s){o-=s.xyz;float b=dot(o,d),h=b*b-dot(o,o)+s.w*s.w;if(h<0.)return 1e5;h=sqrt(h);b=-b;return b-h>0.?b-h:b+h>0.?b+h:1e5;}
void mainImage(out vec4 O,vec2 u){
    vec4 g=vec4(0,0,-3.5,.7),m=vec4(-1.5,.2,-5,.9);
    V o[8],d[8],k[8],c=V(0);int z[8],i=0;
    o[0]=V(0);d[0]=normalize(V(u+u-R.xy,-2.*R.x));k[0]=V(1);z[0]=1;
    for(;i>=0;){
        V a=o[i],b=d[i],w=k[i];int q=z[i--];
        float x=S(a,b,g),y=S(a,b,m),f=-(1.03+a.y)/b.y,t;
        if(f<0.)f=1e5;
        t=min(f,min(x,y));
        V p=a+b*t;
        if(t>9e4){c+=w*mix(V(.3,.5,.7),V(1,.95,.8),.5+.5*b.y);continue;}
        if(t==f){c+=w*abs(b.y)*(int(floor(p.x)+floor(p.z)+1e3)%2==1?V(.2):V(1));continue;}
        if(q>5)continue;
        if(t==y){V n=(p-m.xyz)/m.w;++i;o[i]=p+n*E;d[i]=reflect(b,n);k[i]=w*V(.9,.7,.7);z[i]=q+1;continue;}
        V n=(p-g.xyz)/g.w,r;
        float e=1./1.4,C=-dot(n,b),F;
        float K=C;
        if(C<0.)n=-n,C=-C,e=1.4;
        r=refract(b,n,e);
        K=K<0.?-dot(r,n):C; // Schlick wants the angle in air
        F=.4/2.4;F*=F;
        F+=(1.-F)*pow(max(1.-K,0.),5.);
        if(dot(r,r)<.5)F=1.;
        else{++i;o[i]=p-n*E;d[i]=r;k[i]=w*.9*(1.-F);z[i]=q+1;}
        ++i;o[i]=p+n*E;d[i]=reflect(b,n);k[i]=w*.9*F;z[i]=q+1;
    }
    O=vec4(c,1);
}
